// Vega comes as modules that ask for each other by name: this lets them.
"use strict";
const modules = new Map();
function define(name, body) {
  modules.set(name, { body, exports: null });
}
function moduleNamed(name) {
  const found = modules.get(name === "vega-selections" ? "vega-selection" : name);
  if (!found) throw Error(`the page lacks the module ${name}`);
  if (!found.exports) {
    found.exports = {};
    found.body(found.exports, { exports: found.exports }, moduleNamed);
  }
  return found.exports;
}
