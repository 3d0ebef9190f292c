// Labelled form controls. Each calls back with its value as text, as setPolicyKey() takes it.

let number = 0;

function labelled(text, control, after = []) {
  const label = document.createElement('label');
  const words = document.createElement('span');
  words.textContent = text;
  control.id = `control-${++number}`;
  label.htmlFor = control.id;
  label.className = 'control';
  label.append(words, control, ...after);
  return label;
}

export function select(text, values, value, change) {
  const control = document.createElement('select');
  for (const each of values) {
    const [key, name] = Array.isArray(each) ? each : [each, each];
    control.add(new Option(name, key, false, key === value));
  }
  control.onchange = () => change(control.value);
  return labelled(text, control);
}

export function slider(text, {min, max, step}, value, change) {
  const control = document.createElement('input');
  Object.assign(control, {type: 'range', min, max, step, value});
  const shown = document.createElement('output');
  shown.textContent = value;
  control.oninput = () => {
    shown.textContent = control.value;
    change(control.value);
  };
  return labelled(text, control, [shown]);
}

export function checkbox(text, checked, change) {
  const control = document.createElement('input');
  Object.assign(control, {type: 'checkbox', checked});
  control.onchange = () => change(control.checked);
  const label = labelled(text, control);
  label.classList.add('check');
  return label;
}

export function button(text, press) {
  const control = document.createElement('button');
  control.type = 'button';
  control.textContent = text;
  control.onclick = press;
  return control;
}
