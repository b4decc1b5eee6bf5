// Under the picture: the load steps as a table, the facts of the run, notes, and the problem as it was resolved.

import { Header } from './data';
import { duration, short } from './numbers';

function element<K extends keyof HTMLElementTagNameMap>(tag: K, text = '', className = ''): HTMLElementTagNameMap[K] {
  const e = document.createElement(tag);
  if (text) e.textContent = text;
  if (className) e.className = className;
  return e;
}

function section(title: string, ...content: Node[]): HTMLElement {
  const out = element('div');
  out.style.minWidth = '0';
  out.append(element('h2', title), ...content);
  return out;
}

function stepTable(header: Header, choose: (step: number) => void): HTMLElement {
  const table = element('table');
  const head = element('tr');
  for (const name of ['step', 't', 'status', 'iterations', 'factorisations', 'energy', 'gradient norm', 'neg. eigenvalues', 'time', '']) head.append(element('th', name));
  const body = element('tbody');
  for (const s of header.steps) {
    const row = element('tr');
    row.dataset.step = String(s.step);
    const negative = s.negative_eigenvalues < 0 ? '–' : String(s.negative_eigenvalues);
    const cells = [String(s.step), short(s.t), s.status, String(s.iterations), String(s.factorisations), short(s.energy, 8), short(s.gradient_norm), negative, duration(s.seconds)];
    for (const text of cells) row.append(element('td', text));
    row.append(element('td', s.reason, 'words'));
    row.addEventListener('click', () => choose(s.step));
    body.append(row);
  }
  const top = element('thead');
  top.append(head);
  table.append(top, body);
  const scroll = element('div', '', 'scroll');
  scroll.append(table);
  return scroll;
}

export function fillDetails(root: HTMLElement, header: Header, choose: (step: number) => void): void {
  if (header.steps.length) root.append(section('Load steps', stepTable(header, choose)));
  const facts = element('dl', '', 'facts');
  const rows: [string, string][] = [...header.facts, ['version', header.version], ['machine', header.machine]];
  for (const [name, value] of rows) {
    if (!value) continue;
    const row = element('div');
    row.append(element('dt', name), element('dd', value));
    facts.append(row);
  }
  root.append(section('This run', facts));
  if (header.notes.length) {
    const list = element('ul', '', 'notes');
    for (const note of header.notes) list.append(element('li', note));
    root.append(section('Notes', list));
  }
  if (header.problem) {
    const details = element('details');
    details.id = 'problem';
    details.append(element('summary', 'The problem, with all defaults filled in'), element('pre', header.problem));
    root.append(details);
  }
}

export function markStep(root: HTMLElement, step: number): void {
  for (const row of root.querySelectorAll<HTMLElement>('tr[data-step]')) row.classList.toggle('shown', row.dataset.step === String(step));
}
