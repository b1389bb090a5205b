"use strict";
showCurves(document.getElementById("curves"));
showGrains(document.getElementById("grains"));
