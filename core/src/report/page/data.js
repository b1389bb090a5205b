// Data of the page: one JSON, and numbers deflated and in base64.
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
/** The float64 numbers of a data element; inflated once. */
function numbersOf(number) {
  if (!doubles.has(number)) doubles.set(number, inflated(number).then((buffer) => new Float64Array(buffer)));
  return doubles.get(number);
}

/** 16-bit numbers from byte planes: all low bytes, then all high bytes. */
async function planesOf(number) {
  const bytes = new Uint8Array(await inflated(number));
  const count = bytes.length / 2;
  const numbers = new Uint16Array(count);
  for (let i = 0; i < count; ++i) numbers[i] = bytes[i] | (bytes[count + i] << 8);
  return numbers;
}

/** An element with attributes (or DOM properties) and children. */
function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes))
    if (typeof value === "function" || name in element) element[name] = value;
    else element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/** Sets the entries [value, label] of a choice; unchanged if it has them already, as it may be open. */
function offer(choice, entries) {
  const now = Array.from(choice.options, (one) => [one.value, one.label]);
  if (JSON.stringify(now) !== JSON.stringify(entries)) choice.replaceChildren(...entries.map(([value, label]) => make("option", { value }, label)));
}

/** Saves a file on the user's machine. Tests inspect the last one. */
function save(name, content, type) {
  const blob = content instanceof Blob ? content : new Blob([content], { type });
  save.last = { name, blob };
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

/** A number with four digits: 0.0123, 12.35, 1.2e+7. */
function readable(value) {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential(2) : String(+value.toPrecision(4));
  return text.replace("-", "−");
}

/** Seconds with the best prefix for times up to `largest`. */
function writtenTime(seconds, largest = seconds) {
  const size = Math.abs(largest), [factor, unit] = size >= 1 || size === 0 ? [1, "s"] : size >= 1e-3 ? [1e3, "ms"] : [1e6, "µs"];
  return `${readable(seconds * factor)} ${unit}`;
}

/** A unit after a number. */
const ofUnit = (unit) => (unit === "1" || unit === "" ? "" : unit === "°" ? "°" : ` ${unit}`);

/** A label with its unit. */
const withUnit = (label, unit) => (unit === "1" || unit === "" ? label : `${label} [${unit}]`);
