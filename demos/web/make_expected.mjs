// make_expected.mjs STILLFRAME STEPS.json OUT.json: what the native program makes of the page's
// scenes. Each entry of "bytes" as its --hash lines; of each step, scene and pane the hashes of the
// first frames.

import {execFileSync} from 'node:child_process';
import {readFileSync, renameSync, writeFileSync} from 'node:fs';

const kFrames = 24;
const [program, stepsFile, out] = process.argv.slice(2);
const settings = JSON.parse(readFileSync(stepsFile, 'utf8'));

function hashLines({scene, width, height, frames, aa, taa}) {
  const words = ['render', `builtin:${scene}`, '--resolution', `${width}x${height}`, '--frames',
    String(frames), '--aa', aa, '--hash'];
  if (taa) {
    words.push('--taa', taa);
  }
  return execFileSync(program, words, {encoding: 'utf8', maxBuffer: 1 << 24});
}

function paneHashes(step, scene, {aa, taa}) {
  if (aa.startsWith('ssaa')) {
    return null; // converges on the page, sample by sample
  }
  const keys = Object.entries(taa ?? {}).map(([key, value]) => `${key}=${value}`).join(',');
  const {width, height} = step;
  const lines = hashLines({scene, width, height, frames: kFrames, aa, taa: keys});
  return lines.trim().split('\n').map((line) => line.split(' ')[3]);
}

const steps = {};
for (const step of settings.steps) {
  steps[step.id] = {};
  for (const scene of step.scenes?.map(([name]) => name) ?? [step.scene]) {
    steps[step.id][scene] = {
      left: paneHashes(step, scene, step.left),
      right: paneHashes(step, scene, step.right),
    };
  }
}
const bytes = settings.bytes.map((job) => ({job, lines: hashLines(job)}));
writeFileSync(`${out}.part`, JSON.stringify({bytes, steps}));
renameSync(`${out}.part`, out);
