// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// What `doorforge validate` says of many items: a list to choose from, and the one that is chosen in 3D.

import { ObjectView } from './object_view.js';
import { RecordView } from './record_view.js';
import { h } from './dom.js';

const plural = (n, word) => `${n} ${word}${n === 1 ? '' : 's'}`;
const stateOf = ({ errors, warnings, findings }) => (findings.length ? [errors ? plural(errors, 'error') : null, warnings ? plural(warnings, 'warning') : null].filter(Boolean).join(', ') || 'told' : 'passed');

export class FindingsView {
  constructor(content) {
    this.content = content;
    this.items = content.document.items;
    this.views = new Map();
    this.select = h('select', { id: 'item', onchange: () => this.load(Number(this.select.value)) }, this.items.map((item, i) => h('option', { value: i }, `${item.path}: ${stateOf(item)}`)));
    this.only = h('input', { type: 'checkbox', id: 'only', onchange: () => this.filter() });
    this.holder = h('div', { class: 'findings-holder' });
    this.element = h('main', {}, this.head(), this.holder);
  }

  head() {
    const all = (key) => this.items.reduce((sum, item) => sum + item[key], 0);
    const text = `${plural(this.items.length, 'item')}, ${plural(all('errors'), 'error')}, ${plural(all('warnings'), 'warning')}`;
    const choose = this.items.length > 1 ? [h('label', { for: 'item' }, 'Shown'), this.select, h('label', { class: 'check', for: 'only' }, this.only, 'with findings only')] : [];
    return h('header', { class: 'chooser' }, h('strong', {}, text), ...choose);
  }

  start() {
    const first = this.items.findIndex(({ findings }) => findings.length > 0);
    if (this.items.length === 0) return this.holder.append(h('p', { class: 'panel' }, 'Nothing was checked.'));
    this.select.value = Math.max(first, 0);
    this.load(Math.max(first, 0));
  }

  filter() {
    [...this.select.options].forEach((option, i) => {
      const hide = this.only.checked && this.items[i].findings.length === 0;
      option.hidden = option.disabled = hide;
    });
  }

  load(i) {
    const item = this.items[i];
    const View = item.record ? RecordView : ObjectView;
    if (!this.views.has(View)) this.views.set(View, new View(this.content));
    const view = this.views.get(View);
    const isNew = view !== this.view;
    if (isNew) {
      this.holder.replaceChildren(view.element);
      if (!view.stage) view.start();
      else view.stage.resize();
      this.view = view;
    }
    view.load(item.record ?? item);
  }
}
