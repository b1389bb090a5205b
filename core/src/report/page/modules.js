// Module loader for Vega, whose modules require each other by name.
"use strict";
const modules = new Map();
function define(name, body) {
  modules.set(name, { body, exports: null });
}
function moduleNamed(name) {
  const found = modules.get(name === "vega-selections" ? "vega-selection" : name);
  if (!found) throw Error(`module ${name} is missing in the page`);
  if (!found.exports) {
    found.exports = {};
    found.body(found.exports, { exports: found.exports }, moduleNamed);
  }
  return found.exports;
}
