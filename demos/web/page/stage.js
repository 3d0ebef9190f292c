// One live scene: canvas, divider, buttons, controls, the picked pixel's story and the check of its
// bytes against the native build.

import {button, checkbox, select, slider} from './controls.js';

const kMinFrameMs = 1000 / 30;
const kInMemory = {willReadFrequently: true}; // nothing but the processor makes the pixels
const kDividerReach = 0.04; // of the width, on either side

function element(tag, className, text = '') {
  const made = document.createElement(tag);
  made.className = className;
  made.textContent = text;
  return made;
}

const paneWish = (pane) => ({
  aa: pane.aa,
  taa: Object.entries(pane.taa ?? {}).map(([key, value]) => `${key}=${value}`).join(','),
  view: pane.view ?? 'picture',
});

export class Stage {
  #engine;
  #step; // as in steps.json, with the reader's changes
  #expected;
  #root;
  #canvas;
  #visible = false;
  #open = false;
  #opened = 0; // how often: loops of earlier times end
  #busy = Promise.resolve();
  #playing;
  #original; // modes of both sides as they are in steps.json
  #steered = false; // the camera was moved since the scene was opened
  #divider = 0.5;
  #picked = null;
  #magnify = false;
  #lastDraw = 0;
  frames = 0; // drawn so far, for tests

  constructor(engine, step, catalogue, expected, root) {
    this.#engine = engine;
    this.#step = structuredClone(step);
    this.#original = this.#modes();
    this.#expected = expected;
    this.#root = root;
    this.#playing = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.#build(catalogue);
    new IntersectionObserver(([entry]) => this.#show(entry.isIntersecting), {rootMargin: '10%'})
      .observe(root);
  }

  // What is on the page.

  #build(catalogue) {
    const {width, height, title} = this.#step;
    const frame = element('div', 'frame');
    this.#canvas = element('canvas', 'picture');
    Object.assign(this.#canvas, {width, height, tabIndex: 0});
    this.#canvas.setAttribute('role', 'application');
    this.#canvas.setAttribute('aria-label', `${title}: live picture, ${width} × ${height} pixels. ` +
      (this.#step.steer ? 'Arrow keys circle, plus and minus go nearer and farther, 0 goes back.'
                        : 'Arrow keys pick a pixel, whose story is told below.'));
    this.#labels = ['left', 'right'].map((side) => element('span', `side ${side}`));
    frame.append(this.#canvas, ...this.#labels);
    this.#divide = slider('Divider', {min: 0, max: 100, step: 1}, 50, (value) => {
      this.#divider = value / 100;
      this.#configure();
    });
    this.#divide.classList.add('divide');
    this.#playButton = button('', () => this.play(!this.#playing));
    const bar = element('div', 'bar');
    bar.append(this.#playButton, button('One frame', () => this.#oneFrame()),
      button('From the start', () => this.#restart()), this.#divide);
    this.#controls = element('div', 'controls');
    this.#legend = element('p', 'legend');
    this.#told = element('p', 'told');
    this.#buildStory(catalogue);
    this.#trouble = element('p', 'trouble');
    this.#trouble.setAttribute('role', 'alert');
    this.#root.append(frame, bar, this.#controls, this.#legend, this.#told, this.#story,
      this.#trouble);
    this.#buildControls(catalogue);
    this.#steering();
    this.#nameSides();
    this.#namePlay();
  }
  #buildStory(catalogue) {
    this.#story = element('details', 'story');
    this.#story.hidden = true;
    this.#story.open = true;
    this.#plot = element('canvas', 'plot');
    Object.assign(this.#plot, {width: 2 * catalogue.plot_side, height: catalogue.plot_side});
    this.#plot.setAttribute('role', 'img');
    this.#plot.setAttribute('aria-label', 'The colours of the neighbourhood and of history, ' +
      'as Y over Co and Y over Cg; the same is told in words.');
    this.#lines = element('div', 'lines');
    this.#story.append(element('summary', '', 'The picked pixel'), this.#plot, this.#lines);
  }

  #labels;
  #legend;
  #plot;
  #lines;
  #divide;
  #playButton;
  #controls;
  #told;
  #story;
  #trouble;

  #buildControls(catalogue) {
    const step = this.#step;
    if (step.scenes) {
      this.#controls.append(select('Scene', step.scenes, step.scene, (scene) => {
        step.scene = scene;
        this.#restart();
      }));
    }
    for (const control of step.controls ?? []) {
      this.#controls.append(this.#control(control, catalogue));
    }
    for (const overlay of step.overlays ?? []) {
      this.#controls.append(this.#overlay(overlay));
    }
    this.#controls.append(checkbox('Magnify the picked pixel', false, (on) => {
      this.#magnify = on;
      this.#picked ??= [step.width >> 1, step.height >> 1];
      this.#pickAt(...this.#picked);
    }));
  }

  /// Drawn over both sides: "edges", "tiles", "grid", "axes", "arrows".
  #overlay({name, label}) {
    return checkbox(label, false, (on) => {
      this.#overlays[name] = on;
      this.#configure();
    });
  }
  #overlays = {};

  #control({pane, what, key, label, min, max, step, values, names}, catalogue) {
    const target = this.#step[pane];
    const change = (value) => {
      if (what === 'aa' || what === 'view') {
        target[what] = value;
        this.#explainViews(catalogue);
        if (what === 'aa') {
          target.taa = {};
          target.label = null;
        }
      } else {
        target.taa[key] = value;
      }
      this.#nameSides();
      this.#configure();
    };
    if (what === 'aa') {
      const presets = catalogue.presets.map(({name}) => [`taa:${name}`, name]);
      return select(label, [['none', 'raw'], ['fxaa', 'fxaa'], ...presets, ['ssaa:64', 'ssaa:64']],
        target.aa, change);
    }
    if (what === 'view') {
      return select(label, catalogue.views.map(({name}) => name), target.view ?? 'picture', change);
    }
    if (values) {
      const pairs = values.map((value, i) => [value, names?.[i] ?? value]);
      return select(label, pairs, target.taa[key], change);
    }
    return slider(label, {min, max, step}, target.taa[key], change);
  }

  /// What the colours of the chosen views mean.
  #explainViews({views}) {
    const chosen = [this.#step.left.view, this.#step.right.view];
    this.#legend.textContent = views
      .filter(({name}) => name !== 'picture' && chosen.includes(name))
      .map(({name, about}) => `${name}: ${about}`)
      .join('. ');
  }

  #nameSides() {
    ['left', 'right'].forEach((side, i) => {
      const {label, aa} = this.#step[side];
      this.#labels[i].textContent = label ?? aa.replace('taa:', '').replace('none', 'raw');
    });
  }

  #namePlay() {
    this.#playButton.textContent = this.#playing ? 'Pause' : 'Play';
  }

  // Input.

  #steering() {
    const canvas = this.#canvas;
    let drag = null;
    const place = (event) => {
      const box = canvas.getBoundingClientRect();
      return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    };
    canvas.onpointerdown = (event) => {
      const [x, y] = place(event);
      const divide = Math.abs(x - this.#divider) < kDividerReach;
      drag = {x, y, divide, moved: false};
      if (divide || this.#step.steer) {
        canvas.setPointerCapture(event.pointerId);
      }
    };
    canvas.onpointermove = (event) => {
      const [x, y] = place(event);
      canvas.style.cursor = Math.abs(x - this.#divider) < kDividerReach ? 'ew-resize' : '';
      if (!drag) {
        return;
      }
      drag.moved ||= Math.hypot(x - drag.x, y - drag.y) > 0.01;
      if (drag.divide) {
        this.#setDivider(x);
      } else if (this.#step.steer && drag.moved) {
        this.#move('orbit', (drag.x - x) / 2, (y - drag.y) / 4);
        Object.assign(drag, {x, y});
      }
    };
    canvas.onpointerup = (event) => {
      const [x, y] = place(event);
      if (drag && !drag.divide && !drag.moved) {
        this.#pickAt(Math.floor(x * canvas.width), Math.floor(y * canvas.height));
      }
      drag = null;
    };
    canvas.onpointercancel = () => {
      drag = null;
    };
    canvas.onkeydown = (event) => this.#key(event);
  }

  #key(event) {
    const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
    const arrow = arrows[event.key];
    if (this.#step.steer && (arrow || '+-0'.includes(event.key))) {
      if (arrow) {
        this.#move('orbit', arrow[0] / 48, -arrow[1] / 96);
      } else {
        this.#move(event.key === '0' ? 'reset' : 'dolly', event.key === '+' ? 0.9 : 1 / 0.9, 0);
      }
    } else if (arrow) {
      const [x, y] = this.#picked ?? [this.#canvas.width >> 1, this.#canvas.height >> 1];
      this.#pickAt(x + arrow[0], y + arrow[1]);
    } else if (event.key === ' ') {
      this.play(!this.#playing);
    } else {
      return;
    }
    event.preventDefault();
  }

  #setDivider(x) {
    this.#divider = Math.min(Math.max(x, 0), 1);
    const control = this.#divide.querySelector('input');
    control.value = Math.round(this.#divider * 100);
    control.oninput();
  }

  #pickAt(x, y) {
    const {width, height} = this.#step;
    this.#picked = [Math.min(Math.max(x, 0), width - 1), Math.min(Math.max(y, 0), height - 1)];
    this.#ask('pick', {x: this.#picked[0], y: this.#picked[1]});
    this.#configure();
  }

  #move(kind, x, y) {
    this.#steered = true;
    this.#ask('move', {kind, x, y});
    this.#draw();
  }

  /// Resolves when all that was asked for is done.
  settled() {
    return this.#busy;
  }

  play(on) {
    this.#playing = on;
    this.#namePlay();
    this.#configure();
  }

  #oneFrame() {
    this.play(false);
    this.#ask('scrub', {frame: Number(this.#root.dataset.frame) + 1});
    this.#draw();
  }

  #restart() {
    this.#close();
    this.#steered = false;
    this.#checked.clear();
    this.#show(this.#visible);
  }

  // The engine. Requests of a stage follow each other.

  #ask(op, values = {}) {
    if (!this.#open) {
      return Promise.resolve();
    }
    return this.#queue(() => this.#engine.ask(op, {key: this.#step.id, ...values}));
  }

  #queue(task) {
    const done = this.#busy.then(task).catch((error) => {
      this.#trouble.textContent = error.message;
    });
    this.#busy = done;
    return done;
  }

  #wish() {
    const [x, y] = this.#picked ?? [0, 0];
    return {
      left: paneWish(this.#step.left),
      right: paneWish(this.#step.right),
      split: true,
      divider: this.#divider,
      playing: this.#playing,
      overlays: Object.keys(this.#overlays).filter((name) => this.#overlays[name]),
      magnifier: this.#magnify ? {x, y, factor: 8} : null,
    };
  }

  #configure() {
    this.#ask('configure', {wish: this.#wish()});
    this.#draw();
  }

  #show(visible) {
    this.#visible = visible;
    if (!visible) {
      this.#close();
    } else if (!this.#open) {
      this.#open = true;
      this.#told.textContent = 'opening …';
      this.#openScene();
      this.#loop(++this.#opened);
    }
  }

  #close() {
    this.#ask('close');
    this.#open = false;
  }

  #openScene() {
    const {scene, width, height} = this.#step;
    const what = this.#dropped ?? {scene};
    this.#trouble.textContent = '';
    const done = this.#ask(this.#dropped ? 'load' : 'open',
      {...what, width, height, wish: this.#wish()});
    this.#draw();
    return done;
  }

  /// Another scene in this place: files dropped by the reader.
  async load(files, main) {
    const before = this.#dropped;
    this.#dropped = {files, main};
    if (!await this.#openScene()) {
      this.#dropped = before; // which is still there
    }
  }
  #dropped = null;

  async #loop(opened) {
    const goesOn = () => this.#open && this.#opened === opened;
    while (goesOn()) {
      const wait = kMinFrameMs - (performance.now() - this.#lastDraw);
      if (wait > 0) {
        await new Promise((resolve) => setTimeout(resolve, wait));
      }
      await new Promise(requestAnimationFrame);
      if (goesOn() && this.#playing) {
        await this.#draw();
      }
    }
  }

  async #draw() {
    this.#lastDraw = performance.now();
    const drawn = await this.#ask('draw');
    if (!drawn) {
      return;
    }
    if (drawn.pixels) {
      const {width, height} = this.#canvas;
      this.#canvas.getContext('2d', kInMemory).putImageData(
        new ImageData(new Uint8ClampedArray(drawn.pixels), width, height), 0, 0);
      ++this.frames;
    }
    this.#tell(drawn);
    if (this.#picked) {
      await this.#tellStory();
    }
  }

  async #tellStory() {
    const story = await this.#ask('story');
    if (!story) {
      return;
    }
    const plot = this.#plot.getContext('2d', kInMemory);
    const side = this.#plot.height;
    plot.putImageData(new ImageData(new Uint8ClampedArray(story.pixels), 2 * side, side), 0, 0);
    this.#story.hidden = false;
    this.#lines.replaceChildren(...story.lines.map(({heading, text, swatch}) => {
      const line = element(heading ? 'h4' : 'p', '', text);
      if (swatch) {
        const colour = element('span', 'swatch');
        colour.style.background = `rgb(${swatch})`;
        line.prepend(colour);
      }
      return line;
    }));
  }

  #tell({report, ms}) {
    const {frame, left, right} = report;
    this.#root.dataset.frame = frame;
    this.#root.dataset.hash = `${left.hash} ${right?.hash}`;
    const speed = left.at_rest && right?.at_rest ? 'finished' : `${ms.toFixed(1)} ms`;
    this.#told.textContent = `frame ${frame} · ${speed} · ${left.hash} | ${right?.hash} `;
    const verdict = this.#check(report);
    if (verdict) {
      this.#told.append(verdict);
    }
  }

  /// Both panes' bytes against the native build's, where there are any for this frame. Where
  /// nothing happens frames differ by their samples alone, and count on.
  #check({frame, last_frame: lastFrame, left, right}) {
    const native = this.#expected?.[this.#step.scene];
    if (!native || this.#steered || this.#modes() !== this.#original) {
      return null;
    }
    for (const [pane, hashes] of [[left, native.left], [right, native.right]]) {
      const index = pane.frames - 1;
      if (hashes?.[index] && (lastFrame === 0 || index === frame)) {
        this.#checked.add(index);
        if (hashes[index] !== pane.hash) {
          this.#differs = index;
        }
      }
    }
    this.#root.dataset.checked = this.#checked.size;
    if (this.#differs !== null) {
      this.#root.dataset.differs = this.#differs;
      return element('strong', 'differs', `✗ frame ${this.#differs} has other bytes than natively`);
    }
    return this.#checked.size === 0 ? null
      : element('strong', 'same', `✓ the native build’s bytes, ${this.#checked.size} of 24 frames`);
  }
  #modes() {
    return JSON.stringify([this.#step.left, this.#step.right].map(({aa, taa}) => [aa, taa]));
  }
  #checked = new Set();
  #differs = null;
}
