// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Search that works from the disk. The one of mkdocs starts a worker and fetches its index, which a browser allows no page of the
// disk; here the index is a script. Words are looked for as they are written, so that --handle-front is one.
'use strict';
(() => {
  const MOST = 30; // results
  const AROUND = 90; // [characters] shown before and after a word
  const field = document.getElementById('mkdocs-search-query');
  const results = document.getElementById('mkdocs-search-results');
  let sections = null;

  const load = () => {
    if (sections) return Promise.resolve();
    return new Promise((done, failed) => {
      const script = document.createElement('script');
      script.src = `${base_url}/search/index.js`;
      script.onload = () => {
        sections = window.searchSections.map((section) => ({ ...section, words: section.text.toLowerCase(), heads: `${section.title} ${section.page}`.toLowerCase() }));
        done();
      };
      script.onerror = failed;
      document.head.append(script);
    });
  };

  const count = (text, word) => text.split(word).length - 1;

  // Of a section in which every word occurs: words in headings count more, and more so on short pages.
  const score = ({ words, heads }, wanted) =>
    wanted.reduce((sum, word) => {
      const inHeads = count(heads, word);
      const inText = count(words, word);
      return inHeads + inText === 0 ? -Infinity : sum + 10 * inHeads + Math.log2(1 + inText);
    }, 0);

  // The text around the first word, with every word marked.
  const excerpt = ({ text, words }, wanted) => {
    const at = Math.max(0, Math.min(...wanted.map((word) => words.indexOf(word)).filter((place) => place >= 0), text.length) - AROUND);
    const from = at === 0 ? 0 : text.indexOf(' ', at) + 1;
    const end = text.indexOf(' ', from + 2 * AROUND);
    const shown = text.slice(from, end < 0 ? text.length : end);
    const line = document.createElement('p');
    line.append(from > 0 ? '… ' : '');
    const escaped = wanted.map((word) => word.replace(/[.*+?^${}()|[\]\\]/g, '\\$&'));
    shown.split(new RegExp(`(${escaped.join('|')})`, 'i')).forEach((piece, i) => {
      const mark = i % 2 === 1 ? document.createElement('mark') : document.createElement('span');
      mark.textContent = piece;
      line.append(mark);
    });
    line.append(from + shown.length < text.length ? ' …' : '');
    return line;
  };

  const entry = (section, wanted) => {
    const link = document.createElement('a');
    link.href = `${base_url}/${section.location}`;
    link.textContent = section.page === section.title ? section.page : `${section.page}: ${section.title}`;
    const heading = document.createElement('h3');
    heading.append(link);
    const article = document.createElement('article');
    article.append(heading, excerpt(section, wanted));
    return article;
  };

  const search = async () => {
    const asked = field.value;
    const wanted = asked.toLowerCase().split(/\s+/).filter(Boolean);
    if (wanted.join('').length < 2) return results.replaceChildren();
    try {
      await load();
    } catch {
      return results.replaceChildren('The index of the search, search/index.js, is not there.');
    }
    if (asked !== field.value) return; // something else has been typed since
    const found = sections.map((section) => [score(section, wanted), section]).filter(([points]) => points > 0).sort((a, b) => b[0] - a[0]);
    const said = document.createElement('p');
    said.className = 'found';
    said.textContent = found.length === 0 ? 'Nothing was found.' : `${found.length} found${found.length > MOST ? `, the first ${MOST}:` : ''}`;
    results.replaceChildren(said, ...found.slice(0, MOST).map(([, section]) => entry(section, wanted)));
  };

  results.setAttribute('role', 'status');
  field.setAttribute('aria-label', 'Search');
  field.form.addEventListener('submit', (event) => {
    event.preventDefault(); // Enter goes to the first that was found
    results.querySelector('a')?.click();
  });
  field.addEventListener('input', search);
  const given = new URLSearchParams(location.search).get('q');
  if (given) {
    field.value = given;
    search();
  }
})();
