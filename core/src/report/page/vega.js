// Of Vega: what draws curves, with the transforms that axes, legends and labels are made of.
const vega = (() => {
  const { transforms } = moduleNamed("vega-dataflow");
  for (const name of ["vega-transforms", "vega-view-transforms", "vega-encode"]) Object.assign(transforms, moduleNamed(name));
  return {
    parse: moduleNamed("vega-parser").parse,
    View: moduleNamed("vega-view").View,
    scheme: moduleNamed("vega-scale").scheme,
  };
})();
