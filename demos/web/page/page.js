// Builds the page: the stages of the steps, the atlas, the open field, and the check of bytes.

import {chooseBuild, Engine} from './engine.js';
import {Stage} from './stage.js';

const json = async (name) => (await fetch(name)).json();

function tell(id, text) {
  document.getElementById(id).textContent = text;
}

/// Three scenes, all planes of all frames, against what the native build made of them.
async function checkBytes(engine, expected) {
  const rows = document.querySelector('#bytes tbody');
  let same = true;
  for (const {job, lines} of expected) {
    const found = await engine.ask('hashes', {job});
    const equal = found === lines;
    same &&= equal;
    const row = rows.insertRow();
    for (const text of [job.scene, `${job.width} × ${job.height}, ${job.frames} frames`,
      lines.trim().split('\n').pop().split(' ')[3],
      found.trim().split('\n').pop().split(' ')[3], equal ? '✓ same' : '✗ other']) {
      row.insertCell().textContent = text;
    }
    row.className = equal ? 'same' : 'differs';
  }
  tell('verdict', same ? 'The same bytes in the browser.' : 'The bytes differ.');
  document.getElementById('verdict').dataset.same = same;
}

function buildAtlas(engine, step, catalogue) {
  const root = document.getElementById('atlas-stage');
  const about = document.getElementById('failure');
  const show = (name) => {
    const found = catalogue.atlas.find((each) => each.name === name);
    about.textContent = found.failure;
  };
  const scenes = catalogue.atlas.map(({name}) => [`atlas-${name}`, name]);
  const stage = new Stage(engine, {...step, scenes}, catalogue, null, root);
  root.querySelector('select').addEventListener('change',
    (event) => show(event.target.value.replace('atlas-', '')));
  show(step.scene.replace('atlas-', ''));
  return stage;
}

/// Files dropped on the open field, or chosen: one OBJ or scene file and what it names.
function acceptFiles(stage, root) {
  const take = async (list) => {
    const files = await Promise.all([...list].map(async (file) =>
      ({name: file.name, bytes: await file.arrayBuffer()})));
    const main = files.find(({name}) => /\.(obj|json)$/i.test(name));
    if (main) {
      await stage.load(files, main.name);
    }
  };
  root.ondragover = (event) => event.preventDefault();
  root.ondrop = (event) => {
    event.preventDefault();
    take(event.dataTransfer.files);
  };
  document.getElementById('files').onchange = (event) => take(event.target.files);
}

/// Where the build with threads does not start, as for want of memory, the other one may.
async function startEngine(build) {
  const engine = new Engine();
  try {
    return {engine, build, catalogue: await engine.start(build)};
  } catch (error) {
    if (build.name === 'single') {
      throw error;
    }
    return startEngine({name: 'single', threads: 1});
  }
}

async function main() {
  const wanted = chooseBuild(location.search, self.crossOriginIsolated,
    navigator.hardwareConcurrency);
  const [settings, expected, {engine, build, catalogue}] = await Promise.all(
    [json('steps.json'), json('expected.json'), startEngine(wanted)]);
  tell('build', build.threads > 1 ? `WebAssembly with SIMD, ${build.threads} threads`
                                  : 'WebAssembly with SIMD, one thread');
  const stages = {};
  for (const step of settings.steps) {
    const root = document.querySelector(`#${step.id} .stage`);
    stages[step.id] = new Stage(engine, step, catalogue, expected.steps[step.id], root);
  }
  stages.atlas = buildAtlas(engine, settings.atlas, catalogue);
  const field = document.getElementById('field-stage');
  stages.field = new Stage(engine, settings.field, catalogue, null, field);
  acceptFiles(stages.field, field);
  document.body.dataset.ready = build.name;
  window.stillframe = {engine, stages}; // for tests
  await checkBytes(engine, expected.bytes);
}

main().catch((error) => tell('build', `Something is missing here: ${error.message}`));
