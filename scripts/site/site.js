// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// What the theme leaves out for readers with a keyboard or a screen reader.
'use strict';
for (const box of document.querySelectorAll('pre, table')) {
  if (box.scrollWidth > box.clientWidth || box.querySelector('code')) box.tabIndex = 0; // it scrolls
}
document.querySelector('.navbar')?.setAttribute('role', 'navigation');
document.querySelector('.navbar-toggler')?.setAttribute('aria-label', 'menu');
for (const title of document.querySelectorAll('.modal-title')) title.setAttribute('aria-level', '2');
