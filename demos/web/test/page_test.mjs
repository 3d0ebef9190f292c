// page_test.mjs SITE OUT: opens the page in a headless Chromium as people would, with threads and
// without, and checks what the README promises. Screenshots go to OUT. Exit code 1 when a check
// fails.

import {mkdirSync, readdirSync, readFileSync, statSync} from 'node:fs';
import {join} from 'node:path';
import {gzipSync} from 'node:zlib';
import {chromium} from 'playwright-core';
import {serve} from './serve.mjs';

const [site, out] = process.argv.slice(2);
const kMostBytes = 3 << 20;
const kChromium = process.env.CHROMIUM ?? '/usr/bin/chromium';
mkdirSync(out, {recursive: true});

let failures = 0;
function check(sentence, holds, details = '') {
  failures += holds ? 0 : 1;
  console.log(`${holds ? 'ok  ' : 'FAIL'} ${sentence}${details === '' ? '' : `: ${details}`}`);
}

function compressedBytes(folder) {
  return readdirSync(folder).reduce((sum, name) => {
    const path = join(folder, name);
    return sum + (statSync(path).isDirectory() ? compressedBytes(path)
                                               : gzipSync(readFileSync(path), {level: 9}).length);
  }, 0);
}

const browser = await chromium.launch({executablePath: kChromium, args: ['--no-sandbox']});
const isolated = await serve(site, 0, true);
const plain = await serve(site, 0, false);
const address = (server, query = '') => `http://127.0.0.1:${server.address().port}/${query}`;

/// A page whose complaints are collected.
async function open(url, options = {}) {
  const context = await browser.newContext({viewport: {width: 1280, height: 800}, ...options});
  const page = await context.newPage();
  page.complaints = [];
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) {
      page.complaints.push(message.text());
    }
  });
  page.on('pageerror', (error) => page.complaints.push(error.message));
  await page.goto(url);
  await page.waitForFunction(() => document.body.dataset.ready, null, {timeout: 60000});
  return page;
}

const stage = (id) => `#${id} .stage`;

async function showStage(page, id) {
  await page.locator(stage(id)).scrollIntoViewIfNeeded();
  await page.waitForFunction((name) => window.stillframe.stages[name].frames >= 3, id,
    {timeout: 60000});
}

/// The picture's bytes, as one number.
const pictureOf = (page, id) => page.locator(`${stage(id)} canvas`).evaluate((canvas) => {
  const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let sum = 7;
  for (const byte of data) {
    sum = (Math.imul(sum, 31) + byte) | 0;
  }
  return sum;
});

async function checkBuild(name, url) {
  const page = await open(url);
  const build = await page.evaluate(() => document.body.dataset.ready);
  check(`${name}: the right build is chosen`, build === name, build);
  await page.waitForFunction(() => document.getElementById('verdict').dataset.same, null,
    {timeout: 120000});
  const rows = await page.locator('#bytes tbody tr').allInnerTexts();
  const same = await page.evaluate(() => document.getElementById('verdict').dataset.same);
  check(`${name}: three scenes have the native build's bytes`, same === 'true' && rows.length === 3,
    rows.join('; '));

  const steps = await page.locator('.step').evaluateAll((all) => all.map(({id}) => id));
  for (const id of steps) {
    await showStage(page, id);
    const {checked, differs} = await page.locator(stage(id)).evaluate(({dataset}) => ({...dataset}));
    check(`${name}: ${id} shows the native build's bytes`, Number(checked) > 0 && !differs,
      differs === undefined ? '' : `frame ${differs}`);
  }
  check(`${name}: nothing complains`, page.complaints.length === 0, page.complaints.join(' | '));
  return page;
}

/// The first frame after a change of `control` differs from that of the scene as it was.
async function checkControls(page) {
  const stages = await page.locator('.stage').evaluateAll((all) =>
    all.map((each) => each.closest('section').id));
  for (const id of stages) {
    await showStage(page, id);
    const root = page.locator(stage(id));
    await root.getByRole('button', {name: 'Pause'}).click();
    const sliders = root.locator('.controls input[type=range]');
    for (let i = 0; i < await sliders.count(); ++i) {
      const slider = sliders.nth(i);
      const label = await slider.locator('xpath=..').locator('span').innerText();
      const pictures = new Set();
      for (const key of ['Home', 'End']) {
        await slider.press(key);
        // Some frames for the past to make a difference.
        for (let frame = 0; frame < 12; ++frame) {
          await root.getByRole('button', {name: 'One frame'}).click();
        }
        await page.evaluate((name) => window.stillframe.stages[name].settled(), id);
        pictures.add(await pictureOf(page, id));
      }
      check(`${id}: "${label}" changes the picture`, pictures.size === 2);
    }
    const before = await pictureOf(page, id);
    await root.locator('.divide input').press('Home');
    await page.evaluate((name) => window.stillframe.stages[name].settled(), id);
    check(`${id}: the divider changes the picture`, before !== await pictureOf(page, id));
  }
}

/// Frames of the courtyard per second, both panes drawn, the page as it is used.
async function frameRate(threads) {
  const page = await open(address(isolated, `?threads=${threads}`));
  await page.waitForFunction(() => document.getElementById('verdict').dataset.same, null,
    {timeout: 120000});
  return page.evaluate(async () => {
    const {engine} = window.stillframe;
    const key = 'rate';
    const result = {};
    for (const aa of ['none', 'taa:still', 'taa:fast']) {
      const wish = {left: {aa, taa: '', view: 'picture'}, split: false, playing: true};
      await engine.ask('open', {key, scene: 'courtyard', width: 640, height: 360, wish});
      for (let i = 0; i < 8; ++i) {
        await engine.ask('draw', {key});
      }
      const frames = 24, begin = performance.now();
      for (let i = 0; i < frames; ++i) {
        await engine.ask('move', {key, kind: 'orbit', x: 1 / 1080, y: 0});
        await engine.ask('draw', {key});
      }
      result[aa] = (1000 * frames / (performance.now() - begin)).toFixed(1);
      await engine.ask('close', {key});
    }
    return result;
  });
}

const shot = (page, name) => page.screenshot({path: join(out, `${name}.png`)});

try {
  const bytes = compressedBytes(site);
  check('the whole site is at most 3 MB compressed', bytes <= kMostBytes, `${bytes} bytes`);
  const threaded = await checkBuild('threads', address(isolated));
  await checkControls(threaded);
  check('after all controls nothing complains', threaded.complaints.length === 0,
    threaded.complaints.join(' | '));
  await threaded.context().close();
  const single = await checkBuild('single', address(plain));
  await single.context().close();
  for (const threads of [1, 2]) {
    console.log(`courtyard 640×360, ${threads} thread(s), frames per second:`,
      JSON.stringify(await frameRate(threads)));
  }
  for (const [name, width, height] of [['laptop', 1280, 800], ['phone', 390, 844]]) {
    const page = await open(address(isolated), {viewport: {width, height}});
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    check(`${name}: nothing sticks out sideways`, wide <= width, `${wide} of ${width}`);
    await shot(page, name);
    for (const id of ['aliasing', 'motion', 'clip', 'rejection', 'filter', 'atlas', 'field']) {
      await showStage(page, id);
      await page.waitForTimeout(1500);
      await page.locator(`#${id}`).screenshot({path: join(out, `${name}_${id}.png`)});
    }
    await page.locator('#bytes').scrollIntoViewIfNeeded();
    await shot(page, `${name}_bytes`);
    check(`${name}: nothing complains`, page.complaints.length === 0, page.complaints.join(' | '));
    await page.context().close();
  }
} finally {
  await browser.close();
  isolated.close();
  plain.close();
}
console.log(failures === 0 ? 'all checks hold' : `${failures} checks failed`);
process.exitCode = failures === 0 ? 0 : 1;
