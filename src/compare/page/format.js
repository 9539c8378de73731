// SPDX-License-Identifier: MIT
// Numbers for people, elements for the page.
const number = (v) => (v === "inf" ? Infinity : v === null || v === undefined ? NaN : v);

function short(v, digits = 3) {
  v = number(v);
  if (Number.isNaN(v)) return "–";
  if (!Number.isFinite(v)) return "∞";
  if (v === 0) return "0";
  const size = Math.abs(v);
  if (size >= 1e5 || size < 1e-3) {
    const [mantissa, exponent] = v.toExponential(digits - 1).split("e");
    return mantissa + "e" + Number(exponent);
  }
  return String(Number(v.toPrecision(digits)));
}

function interval(e, suffix = "") {
  const low = number(e.low), high = number(e.high);
  return Number.isNaN(low) || low === high ? "" : `${short(low)} … ${short(high)}${suffix}`;
}

function element(tag, properties = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name === "class") node.className = value;
    else if (name.startsWith("data-") || name.startsWith("aria-") || name === "role") node.setAttribute(name, value);
    else node[name] = value;
  }
  node.append(...children);
  return node;
}

function svg(tag, attributes = {}, ...children) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

const color = (method) => `var(--c${method % 9})`;
const byId = (id) => document.getElementById(id);

// On a narrow screen each row is a card whose cells name their columns (style.css).
function labelCells(table) {
  const names = [...table.querySelectorAll("thead th")].map((th) => th.textContent);
  for (const row of table.querySelectorAll("tbody tr"))
    [...row.children].forEach((cell, i) => { if (i) cell.setAttribute("data-label", names[i]); });
}
