// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

import { ComposerView } from './composer.js';
import { Content } from './content.js';
import { EpisodeView } from './episode_view.js';
import { FindingsView } from './findings_view.js';
import { Gallery } from './gallery.js';
import { ReportView } from './report_view.js';
import { RecordView } from './record_view.js';
import { h } from './dom.js';

// Several records: a list to choose from.
const chooser = (records, view, name = ({ id }) => id) => {
  if (records.length === 1) return null;
  const select = h('select', { id: 'record', onchange: () => view.load(records[Number(select.value)]) }, records.map((record, i) => h('option', { value: i }, name(record))));
  return h('div', { class: 'chooser' }, h('label', { for: 'record' }, 'Shown'), select);
};

const showRecords = (content) => {
  const { records } = content.document;
  const view = new RecordView(content);
  document.body.append(h('main', {}, chooser(records, view), view.element));
  view.start();
  view.load(records[0]);
  return { view, records };
};

const showGallery = (content) => {
  const gallery = new Gallery(content);
  document.body.append(h('main', {}, gallery.element));
  gallery.start();
  return { gallery };
};

const showEpisodes = (content) => {
  const { episodes } = content.document;
  const view = new EpisodeView(content);
  document.body.append(h('main', {}, chooser(episodes, view, ({ title }) => title), view.element));
  view.start();
  view.load(episodes[0]);
  return { view, episodes };
};

const showComposer = (content) => {
  const composer = new ComposerView(content);
  document.body.append(h('main', {}, composer.element));
  composer.start();
  return { composer, view: composer.view };
};

const showReport = (content) => {
  const report = new ReportView(content);
  document.body.append(h('main', {}, report.element));
  report.start();
  return { report };
};

const showFindings = (content) => {
  const findings = new FindingsView(content);
  document.body.append(findings.element);
  findings.start();
  return { findings };
};

const SHOW = { findings: showFindings, report: showReport, records: showRecords, gallery: showGallery, episodes: showEpisodes, composer: showComposer };

const start = async () => {
  const content = await Content.fromPage();
  const shown = SHOW[content.document.kind](content);
  // what programs that drive the page may use
  window.doorforge = { ...shown, document: content.document };
  await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
  document.documentElement.dataset.ready = Math.round(performance.now());
};

start().catch((error) => {
  document.body.append(h('p', { class: 'fault', role: 'alert' }, `This page cannot be shown: ${error.message}`));
  document.documentElement.dataset.failed = error.message;
  throw error;
});
