// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

/** An element with attributes, listeners (onclick, ...) and children. */
export const h = (tag, attributes = {}, ...children) => {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, '');
    else if (value !== false && value !== undefined && value !== null) element.setAttribute(name, value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return element;
};

export const degrees = (radians) => (radians * 180) / Math.PI;

/** A number for people, without needless digits. */
export const number = (value, digits = 3) => String(Number(value.toPrecision(digits)));

/** A button that copies its `text` and says so. */
export const copyButton = (text, what, name = 'copy') => {
  const button = h('button', { type: 'button', class: 'small', 'aria-label': `copy ${what}`, onclick: async () => {
    await copy(button.text);
    button.textContent = 'copied';
    setTimeout(() => (button.textContent = name), 1500);
  } }, name);
  button.text = text;
  return button;
};

const copy = async (text) => {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const area = h('textarea', { 'aria-hidden': 'true', style: 'position:fixed;opacity:0' }, text); // pages from the disk
    document.body.append(area);
    area.select();
    document.execCommand('copy');
    area.remove();
  }
};

/** Buttons of which one is pressed. `choices` are pairs of value and text. */
export const choice = (title, choices, value, changed) => {
  const buttons = choices.map(([key, text]) => h('button', { type: 'button', 'data-value': key, 'aria-pressed': String(key === value), onclick: () => group.choose(key) }, text));
  const group = h('div', { class: 'choice', role: 'group', 'aria-label': title }, buttons);
  group.choose = (key) => {
    for (const button of buttons) button.setAttribute('aria-pressed', String(button.dataset.value === key));
    changed(key);
  };
  return group;
};

/** A button that stays pressed. */
export const toggle = (text, value, changed) => {
  const button = h('button', { type: 'button', 'aria-pressed': String(value), onclick: () => {
    const pressed = button.getAttribute('aria-pressed') !== 'true';
    button.setAttribute('aria-pressed', String(pressed));
    changed(pressed);
  } }, text);
  return button;
};

/** A labelled slider in degrees with its value behind it; `set` moves it without asking back. */
export const angleSlider = (title, [least, most], changed) => {
  const id = `slider-${title.replace(/\W+/g, '-').toLowerCase()}`;
  const value = h('output', { for: id }, '0°');
  const input = h('input', { type: 'range', id, min: degrees(least).toFixed(2), max: degrees(most).toFixed(2), step: 'any', value: 0, disabled: !(most > least),
    oninput: () => changed((Number(input.value) * Math.PI) / 180),
    onkeydown: (event) => {
      const steps = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[event.key];
      if (!steps) return;
      event.preventDefault();
      changed(((Number(input.value) + steps) * Math.PI) / 180);
    } });
  const row = h('div', { class: 'slider' }, h('label', { for: id }, title), input, value);
  row.set = (angle) => {
    input.value = degrees(angle);
    value.textContent = `${degrees(angle).toFixed(1)}°`;
    input.setAttribute('aria-valuetext', value.textContent);
  };
  return row;
};
