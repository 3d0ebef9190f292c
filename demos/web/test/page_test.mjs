// page_test.mjs SITE DATA OUT: opens the page in a headless Chromium as people would, with threads
// and without, and checks what the README promises. DATA is tests/data; screenshots go to OUT. Exit
// code 1 when a check fails.

import {mkdirSync, readdirSync, readFileSync, statSync} from 'node:fs';
import {join} from 'node:path';
import {gzipSync} from 'node:zlib';
import {chromium} from 'playwright-core';
import {serve} from './serve.mjs';

const [site, data, out] = process.argv.slice(2);
const kMostBytes = 3 << 20;
const kFarFrame = 20; // something moves in every scene by then
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
const pictureOf = (page, id) => page.locator(`${stage(id)} canvas.picture`).evaluate((canvas) => {
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
    const {checked, differs} =
      await page.locator(stage(id)).evaluate(({dataset}) => ({...dataset}));
    check(`${name}: ${id} shows the native build's bytes`, Number(checked) > 0 && !differs,
      differs === undefined ? '' : `frame ${differs}`);
  }
  check(`${name}: nothing complains`, page.complaints.length === 0, page.complaints.join(' | '));
  return page;
}

const settled = (page, id) =>
  page.evaluate((name) => window.stillframe.stages[name].settled(), id);

/// The picture of frame `frames` of the scene, from its start.
async function pictureAfter(page, id, frames) {
  const root = page.locator(stage(id));
  await root.getByRole('button', {name: 'From the start'}).click();
  await settled(page, id);
  for (let frame = 0; frame < frames; ++frame) {
    await root.getByRole('button', {name: 'One frame'}).click();
    await settled(page, id);
  }
  return pictureOf(page, id);
}

/// Every slider gives the same frame another picture somewhere; so does the divider.
async function checkControls(page) {
  const ids = await page.locator('.step').evaluateAll((all) => all.map((each) => each.id));
  for (const id of [...ids, 'atlas', 'field']) {
    await showStage(page, id);
    const root = page.locator(stage(id));
    await root.getByRole('button', {name: 'Pause'}).click();
    const again = [await pictureAfter(page, id, 2), await pictureAfter(page, id, 2)];
    check(`${id}: the same frame is the same picture`, again[0] === again[1]);
    const sliders = root.locator('.controls input[type=range]');
    for (let i = 0; i < await sliders.count(); ++i) {
      const slider = sliders.nth(i);
      const label = await slider.locator('xpath=..').locator('span').innerText();
      const before = await slider.inputValue();
      const pictures = new Set();
      for (const part of [0, 0.25, 1]) {
        await slider.evaluate((input, share) => {
          input.value = Number(input.min) + share * (input.max - input.min);
          input.oninput();
        }, part);
        pictures.add(await pictureAfter(page, id, kFarFrame));
      }
      check(`${id}: "${label}" changes the picture`, pictures.size > 1);
      await slider.fill(before);
    }
    const middle = await pictureAfter(page, id, 2);
    await root.locator('.divide input').press('Home');
    check(`${id}: the divider changes the picture`, middle !== await pictureAfter(page, id, 2));
  }
}

const framesOf = (page, id) => page.evaluate((name) => window.stillframe.stages[name].frames, id);

async function checkPicking(page) {
  await showStage(page, 'clip');
  const root = page.locator(stage('clip'));
  await root.locator('canvas.picture').click({position: {x: 400, y: 100}});
  await root.locator('.story').waitFor({state: 'visible'});
  const clicked = await root.locator('.lines').innerText();
  check('clip: a click on a pixel tells its story', clicked.length > 200,
    `${clicked.length} letters`);
  await root.locator('canvas.picture').focus();
  await page.keyboard.press('ArrowRight');
  await page.waitForFunction((text) => document.querySelector('#clip .lines').innerText !== text,
    clicked);
  const plot = await root.locator('canvas.plot').evaluate((canvas) =>
    new Set(canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data).size);
  check('clip: the plot has something on it', plot > 4);
}

async function checkScreen(page) {
  await page.locator('#bytes').scrollIntoViewIfNeeded();
  await settled(page, 'jitter');
  const before = await framesOf(page, 'jitter');
  await page.waitForTimeout(500);
  check('what is off screen is not drawn', before === await framesOf(page, 'jitter'));
}

async function checkFiles(page) {
  await showStage(page, 'field');
  const before = await pictureOf(page, 'field');
  await page.setInputFiles('#files',
    ['quad.obj', 'quad.mtl', 'bricks.png'].map((name) => join(data, name)));
  await page.waitForFunction((old) => {
    const {dataset} = document.querySelector('#field-stage');
    return dataset.hash !== old;
  }, await page.locator(stage('field')).getAttribute('data-hash'));
  await settled(page, 'field');
  const trouble = page.locator(`${stage('field')} .trouble`);
  check('an OBJ file of the reader is shown',
    before !== await pictureOf(page, 'field') && await trouble.innerText() === '',
    await trouble.innerText());
  await page.locator('#field').screenshot({path: join(out, 'own_file.png')});
  await page.setInputFiles('#files',
    {name: 'broken.obj', mimeType: 'text/plain', buffer: Buffer.from('v 1 2\nf 1 2 3\n')});
  await trouble.filter({hasText: /broken\.obj/}).waitFor();
  const said = await trouble.innerText();
  check('a broken one is named in a line', /^[^\n]*broken\.obj[^\n]*$/.test(said), said);
}

async function checkFallback() {
  const context = await browser.newContext();
  await context.route('**/threads/*', (route) => route.abort());
  const page = await context.newPage();
  await page.goto(address(isolated));
  await page.waitForFunction(() => document.body.dataset.ready, null, {timeout: 60000});
  const build = await page.evaluate(() => document.body.dataset.ready);
  check('where threads do not start the other build does', build === 'single', build);
  await context.close();
}

async function checkReducedMotion() {
  const page = await open(address(isolated), {reducedMotion: 'reduce'});
  await page.locator(stage('jitter')).scrollIntoViewIfNeeded();
  await page.waitForFunction(() => window.stillframe.stages.jitter.frames > 0);
  await page.waitForTimeout(700);
  const frames = await framesOf(page, 'jitter');
  check('who prefers reduced motion sees a picture that stands', frames <= 2, `${frames} frames`);
  await page.context().close();
}

/// Frames of the courtyard per second while the camera circles, by the median of 31: one pane, from
/// the page's question to the answer with its pixels.
async function frameRate(threads) {
  const page = await open(address(isolated, `?threads=${threads}`));
  await page.waitForFunction(() => document.getElementById('verdict').dataset.same, null,
    {timeout: 120000});
  const rates = await page.evaluate(async () => {
    const {engine, stages} = window.stillframe;
    Object.values(stages).forEach((each) => each.play(false));
    const key = 'rate';
    const result = {};
    for (const aa of ['none', 'taa:still', 'taa:fast']) {
      const wish = {left: {aa, taa: '', view: 'picture'}, split: false, playing: true};
      await engine.ask('open', {key, scene: 'courtyard', width: 640, height: 360, wish});
      for (let i = 0; i < 8; ++i) {
        await engine.ask('draw', {key});
      }
      const times = [];
      for (let i = 0; i < 31; ++i) {
        await engine.ask('move', {key, kind: 'orbit', x: 1 / 1080, y: 0});
        const begin = performance.now();
        await engine.ask('draw', {key});
        times.push(performance.now() - begin);
      }
      times.sort((a, b) => a - b);
      const rate = (rank) => (1000 / times[rank]).toFixed(1);
      result[aa] = `${rate(15)} (best tenth ${rate(3)})`;
      await engine.ask('close', {key});
    }
    return result;
  });
  await page.context().close();
  return rates;
}

const shot = (page, name) => page.screenshot({path: join(out, `${name}.png`)});

try {
  const bytes = compressedBytes(site);
  check('the whole site is at most 3 MB compressed', bytes <= kMostBytes, `${bytes} bytes`);
  const threaded = await checkBuild('threads', address(isolated));
  await checkPicking(threaded);
  await checkScreen(threaded);
  await checkControls(threaded);
  await checkFiles(threaded);
  check('after all controls nothing complains', threaded.complaints.length === 0,
    threaded.complaints.join(' | '));
  await threaded.context().close();
  await checkReducedMotion();
  await checkFallback();
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
