// What the page carries: one JSON, and numbers deflated and in base64.
"use strict";
const report = JSON.parse(document.getElementById("report").textContent);

function bytesOfText(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

/** The bytes of a data element, as a promise of an ArrayBuffer. */
function inflated(number) {
  const bytes = bytesOfText(document.getElementById(`data-${number}`).textContent);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

const doubles = new Map();
/** The float64 numbers of a data element; asked for twice, inflated once. */
function numbersOf(number) {
  if (!doubles.has(number)) doubles.set(number, inflated(number).then((buffer) => new Float64Array(buffer)));
  return doubles.get(number);
}

/** 16-bit numbers whose low bytes come first, all together. */
async function planesOf(number) {
  const bytes = new Uint8Array(await inflated(number));
  const count = bytes.length / 2;
  const numbers = new Uint16Array(count);
  for (let i = 0; i < count; ++i) numbers[i] = bytes[i] | (bytes[count + i] << 8);
  return numbers;
}

/** An element with attributes (those of the DOM where they are functions) and children. */
function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes))
    if (typeof value === "function" || name in element) element[name] = value;
    else element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/** The entries [value, label] of a choice; where it has them already it is left alone, as a reader may have it open. */
function offer(choice, entries) {
  const now = Array.from(choice.options, (one) => [one.value, one.label]);
  if (JSON.stringify(now) !== JSON.stringify(entries)) choice.replaceChildren(...entries.map(([value, label]) => make("option", { value }, label)));
}

/** Hands a file to the reader. Tests look at the last one. */
function save(name, content, type) {
  const blob = content instanceof Blob ? content : new Blob([content], { type });
  save.last = { name, blob };
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

/** Four digits that people read: 0.0123, 12.35, 1.2e+7. */
function readable(value) {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential(2) : String(+value.toPrecision(4));
  return text.replace("-", "−");
}

/** Seconds with the prefix that reads best for times up to `largest`. */
function writtenTime(seconds, largest = seconds) {
  const size = Math.abs(largest), [factor, unit] = size >= 1 || size === 0 ? [1, "s"] : size >= 1e-3 ? [1e3, "ms"] : [1e6, "µs"];
  return `${readable(seconds * factor)} ${unit}`;
}

/** Behind a number; units that are shown come as people write them. */
const ofUnit = (unit) => (unit === "1" || unit === "" ? "" : unit === "°" ? "°" : ` ${unit}`);

/** A label with its unit, of an axis as it is shown, of a column as it is in files. */
const withUnit = (label, unit) => (unit === "1" || unit === "" ? label : `${label} [${unit}]`);
