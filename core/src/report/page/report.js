"use strict";
showCurves(document.getElementById("curves"));
showFrames(document.getElementById("grains"), document.getElementById("maps"));
