// The engine lives here, away from the page's thread: messages in, pictures and reports out.
// Each message is {id, op, …}; the answer is {id, value} or {id, error}.
'use strict';

let module, host, plotSide;
const stages = new Map(); // the page's key -> {pointer, width, height}

const call = (name, result, types, values) => module.ccall(name, result, types, values);
const said = () => call('still_text', 'string', ['number'], [host]);

async function start({threads, base}) {
  importScripts(`${base}stillframe_web.js`);
  module = await createStillframe({
    threads,
    locateFile: (name) => base + name,
    mainScriptUrlOrBlob: `${base}stillframe_web.js`,
  });
  host = call('still_host', 'number', ['number'], [threads]);
  const catalogue = JSON.parse(call('still_catalogue', 'string', ['number'], [host]));
  plotSide = catalogue.plot_side;
  return catalogue;
}

function configure({key, wish}) {
  const {pointer} = stages.get(key);
  const wrong = call('still_configure', 'string', ['number', 'number', 'string'],
    [host, pointer, JSON.stringify(wish)]);
  if (wrong) {
    throw new Error(wrong);
  }
}

function adopt({key, width, height, wish}, pointer) {
  if (!pointer) {
    throw new Error(said());
  }
  close({key});
  stages.set(key, {pointer, width, height});
  configure({key, wish});
  return true;
}

function open(message) {
  const {scene, width, height} = message;
  return adopt(message, call('still_open', 'number', ['number', 'string', 'number', 'number'],
    [host, scene, width, height]));
}

/// Files dropped onto the page: an OBJ with what it names, or a scene file.
function load(message) {
  const {files, main, width, height} = message;
  const folder = '/dropped';
  if (!module.FS.analyzePath(folder).exists) {
    module.FS.mkdir(folder);
  }
  module.FS.chdir(folder);
  for (const {name, bytes} of files) {
    module.FS.writeFile(name, new Uint8Array(bytes));
  }
  try {
    return adopt(message, call('still_load', 'number', ['number', 'string', 'number', 'number'],
      [host, main, width, height]));
  } finally {
    for (const {name} of files) {
      module.FS.unlink(name);
    }
  }
}

function close({key}) {
  const stage = stages.get(key);
  if (stage) {
    call('still_close', null, ['number'], [stage.pointer]);
    stages.delete(key);
  }
}

/// Canvases refuse views of a memory that threads share.
const copy = (at, bytes) => module.HEAPU8.slice(at, at + bytes).buffer;

/// The picked pixel's, with its plot; null when none is picked.
function story({key}) {
  const {pointer} = stages.get(key);
  const told = JSON.parse(call('still_story', 'string', ['number', 'number'], [host, pointer]));
  if (told) {
    told.pixels = copy(call('still_plot', 'number', ['number'], [pointer]),
      2 * plotSide * plotSide * 4);
  }
  return told;
}

function draw({key}) {
  const {pointer, width, height} = stages.get(key);
  const begin = performance.now();
  const changed = call('still_draw', 'boolean', ['number'], [pointer]);
  const ms = performance.now() - begin;
  const pixels = changed ? copy(call('still_pixels', 'number', ['number'], [pointer]),
    width * height * 4) : null;
  const report = JSON.parse(call('still_report', 'string', ['number', 'number'], [host, pointer]));
  return {pixels, report, ms};
}

const operations = {
  start,
  open,
  load,
  close,
  configure,
  draw,
  story,
  move: ({key, kind, x, y}) => call('still_move', 'boolean',
    ['number', 'string', 'number', 'number'], [stages.get(key).pointer, kind, x, y]),
  scrub: ({key, frame}) => call('still_scrub', null, ['number', 'number'],
    [stages.get(key).pointer, frame]),
  pick: ({key, x, y}) => call('still_pick', null, ['number', 'number', 'number'],
    [stages.get(key).pointer, x, y]),
  hashes: ({job}) => {
    const lines = call('still_hashes', 'string', ['number', 'string'], [host, JSON.stringify(job)]);
    if (!lines) {
      throw new Error(said());
    }
    return lines;
  },
};

onmessage = async ({data}) => {
  try {
    const value = await operations[data.op](data);
    postMessage({id: data.id, value}, value?.pixels ? [value.pixels] : []);
  } catch (error) {
    postMessage({id: data.id, error: String(error.message ?? error)});
  }
};
