// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// A grid of cards of which only those in view are in the document, so that ten thousand are as quick as ten.

import { h } from './dom.js';

const GAP = 12; // [px]
const SPARE = 1; // rows above and below the view

export class Grid {
  /** `makeCard()` gives an empty card {element, fill(item, place)}. */
  constructor(cardWidth, cardHeight, makeCard) {
    this.cardWidth = cardWidth;
    this.rowHeight = cardHeight + GAP;
    this.makeCard = makeCard;
    this.list = h('ul', { class: 'cards', 'aria-label': 'doors and parts' });
    this.element = h('div', { class: 'grid' }, this.list);
    this.cards = [];
    this.items = [];
    this.first = -1;
    this.element.addEventListener('scroll', () => this.update(), { passive: true });
    new ResizeObserver(() => this.layOut()).observe(this.element);
  }

  show(items) {
    this.items = items;
    this.element.scrollTop = 0;
    this.layOut();
  }

  layOut() {
    const width = this.element.clientWidth - 2 * GAP;
    this.columns = Math.max(1, Math.floor((width + GAP) / (this.cardWidth + GAP)));
    this.width = Math.floor((width - (this.columns - 1) * GAP) / this.columns);
    this.list.style.height = `${Math.ceil(this.items.length / this.columns) * this.rowHeight + GAP}px`;
    this.first = -1;
    this.update();
  }

  update() {
    if (!this.columns) return;
    const rows = Math.ceil(this.element.clientHeight / this.rowHeight) + 1 + 2 * SPARE;
    const first = Math.max(0, Math.floor(this.element.scrollTop / this.rowHeight) - SPARE);
    if (first === this.first) return;
    this.first = first;
    const shown = new Set();
    for (let place = first * this.columns; place < Math.min(this.items.length, (first + rows) * this.columns); ++place) shown.add(place);
    const spare = this.cards.filter((card) => !shown.has(card.place));
    const there = new Map(this.cards.filter((card) => shown.has(card.place)).map((card) => [card.place, card]));
    for (const place of shown) {
      const card = there.get(place) ?? spare.pop() ?? this.newCard();
      if (card.place !== place || card.item !== this.items[place]) this.put(card, place);
    }
    for (const card of spare) {
      card.element.hidden = true;
      card.place = -1;
    }
  }

  /** Fills the cards in view again. */
  refresh() {
    for (const card of this.cards) if (card.place >= 0) card.fill(card.item);
  }

  newCard() {
    const card = { place: -1, ...this.makeCard() };
    this.cards.push(card);
    this.list.append(card.element);
    return card;
  }

  put(card, place) {
    card.place = place;
    card.item = this.items[place];
    const [row, column] = [Math.floor(place / this.columns), place % this.columns];
    card.element.hidden = false;
    card.element.style.transform = `translate(${GAP + column * (this.width + GAP)}px, ${GAP + row * this.rowHeight}px)`;
    card.element.style.width = `${this.width}px`;
    card.element.setAttribute('aria-setsize', this.items.length);
    card.element.setAttribute('aria-posinset', place + 1);
    card.fill(card.item);
  }
}
