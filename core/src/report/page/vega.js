// The parts of Vega that draw curves, with the transforms of axes, legends and labels.
const vega = (() => {
  const { transforms } = moduleNamed("vega-dataflow");
  for (const name of ["vega-transforms", "vega-view-transforms", "vega-encode"]) Object.assign(transforms, moduleNamed(name));
  return {
    parse: moduleNamed("vega-parser").parse,
    View: moduleNamed("vega-view").View,
    scheme: moduleNamed("vega-scale").scheme,
  };
})();
