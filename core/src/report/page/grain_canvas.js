// Draws discs and segments by WebGL2, one point or quad each; and lines, circles and text by a pen, on a canvas or as SVG.
"use strict";

// Software draws points many times faster than quads, but points vanish when their centre leaves the image, and have a maximum size.
const largestPoint = 64; // px

const discVertex = (points) => `#version 300 es
precision highp float;
layout(location=0) in float x; layout(location=1) in float y; layout(location=2) in float z;
layout(location=3) in float radius; layout(location=4) in float place;
uniform vec3 low, span; uniform mat3 axes; uniform vec4 window; uniform vec3 depth; uniform float least;
out vec2 corner; flat out float value; flat out float pixels;
void main() {
  vec3 p = axes * (low + span * vec3(x, y, z));
  float size = max(radius, least);
  value = place; pixels = size / least;
  corner = ${points ? "vec2(0)" : "vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0"};
  gl_PointSize = pixels;
  vec2 at = (p.xy + size * corner - window.xy) * window.zw;
  gl_Position = p.z < depth.x ? vec4(2, 2, 2, 1) : vec4(at, (p.z - depth.y) / depth.z * 1.9 - 0.95, 1);
}`;
const discFragment = (points) => `#version 300 es
precision highp float;
in vec2 corner; flat in float value; flat in float pixels;
uniform sampler2D colours; uniform vec3 grey, paper; uniform float fade;
out vec4 colour;
void main() {
  float r = length(${points ? "gl_PointCoord * 2.0 - 1.0" : "corner"}), soft = 1.0 / max(pixels, 1.0);
  if (r > 1.0) discard;
  vec3 fill = value < 0.0 ? grey : texture(colours, vec2((value * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  float rim = pixels < 3.0 ? 0.0 : smoothstep(1.0 - 2.6 * soft, 1.0 - 1.2 * soft, r);
  colour = vec4(mix(mix(fill, fill * 0.45, rim * 0.8), paper, fade), 1.0 - smoothstep(1.0 - soft, 1.0, r) * step(3.0, pixels));
}`;
const segmentVertex = `#version 300 es
precision highp float;
layout(location=0) in vec2 from; layout(location=1) in vec2 to; layout(location=2) in float width; layout(location=3) in float alpha; layout(location=4) in vec4 tint;
uniform vec4 window; uniform vec2 size;
flat out float shade; flat out vec4 paint;
void main() {
  vec2 a = (from - window.xy) * window.zw * size, b = (to - window.xy) * window.zw * size;
  vec2 along = normalize(b - a + vec2(1e-9, 0)), across = vec2(-along.y, along.x);
  float side = float(gl_VertexID & 1) * 2.0 - 1.0;
  vec2 at = ((gl_VertexID >> 1) == 0 ? a : b) + across * side * width;
  shade = alpha, paint = tint;
  gl_Position = vec4(at / size, 0, 1);
}`;
const segmentFragment = `#version 300 es
precision highp float;
flat in float shade; flat in vec4 paint; uniform vec3 ink; out vec4 colour;
void main() { colour = vec4(mix(ink, paint.rgb, paint.a) * shade, shade); }`;

class GlPainter {
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true, premultipliedAlpha: true });
    if (!gl) throw Error("no WebGL2");
    this.gl = gl;
    this.quads = this.program(discVertex(false), discFragment(false));
    this.points = this.program(discVertex(true), discFragment(true));
    this.segments = this.program(segmentVertex, segmentFragment);
    this.buffers = new Map();
    this.discArray = gl.createVertexArray();
    this.segmentArray = gl.createVertexArray();
    this.texture = gl.createTexture();
  }
  program(vertex, fragment) {
    const { gl } = this, program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text), gl.compileShader(shader), gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw Error(gl.getProgramInfoLog(program));
    return { program, uniform: (name) => gl.getUniformLocation(program, name) };
  }
  /** Fills a buffer with one entry per instance. */
  attribute(array, name, location, list, size, type, normalised) {
    const { gl } = this;
    gl.bindVertexArray(array);
    if (!this.buffers.has(name)) this.buffers.set(name, gl.createBuffer());
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.get(name));
    gl.bufferData(gl.ARRAY_BUFFER, list, gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(location);
    gl.vertexAttribPointer(location, size, type, normalised, 0, 0);
    gl.vertexAttribDivisor(location, 1);
  }
  setBodies({ x, y, z, radius, count }) {
    const { gl } = this;
    [x, y, z].forEach((list, i) => this.attribute(this.discArray, `p${i}`, i, list, 1, gl.UNSIGNED_SHORT, true));
    this.attribute(this.discArray, "radius", 3, radius, 1, gl.FLOAT, false);
    this.count = count;
    this.largest = radius.reduce((a, b) => Math.max(a, b), 0);
  }
  setPlaces(places) {
    this.attribute(this.discArray, "place", 4, places, 1, this.gl.FLOAT, false);
  }
  /** [{from, to, width px, alpha, tint}] as flat lists; see inkOf() on tint. */
  setSegments({ from, to, width, alpha, tint }) {
    const { gl } = this;
    this.attribute(this.segmentArray, "from", 0, from, 2, gl.FLOAT, false);
    this.attribute(this.segmentArray, "to", 1, to, 2, gl.FLOAT, false);
    this.attribute(this.segmentArray, "width", 2, width, 1, gl.FLOAT, false);
    this.attribute(this.segmentArray, "alpha", 3, alpha, 1, gl.FLOAT, false);
    this.attribute(this.segmentArray, "tint", 4, tint, 4, gl.UNSIGNED_BYTE, true);
    this.segmentCount = width.length;
  }
  setColours(table) {
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, Uint8Array.from(table.flatMap((c) => [...c, 255])));
    for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.NEAREST);
    for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
  }
  draw({ low, span, axes, window, depth, metresPerPixel, fade, look, panelWidth }) {
    const { gl } = this, { width, height } = gl.canvas;
    const colour = (hex) => parsed(hex).map((c) => c / 255);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.disable(gl.SCISSOR_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.SCISSOR_TEST), gl.scissor(0, 0, panelWidth, height);
    if (this.count > 0) {
      const points = this.largest / metresPerPixel < largestPoint;
      const { program, uniform } = points ? this.points : this.quads;
      gl.useProgram(program);
      gl.enable(gl.DEPTH_TEST), gl.disable(gl.BLEND), gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
      gl.uniform3fv(uniform("low"), low), gl.uniform3fv(uniform("span"), span);
      gl.uniformMatrix3fv(uniform("axes"), false, axes);
      gl.uniform4fv(uniform("window"), window), gl.uniform3fv(uniform("depth"), depth);
      gl.uniform1f(uniform("least"), metresPerPixel), gl.uniform1f(uniform("fade"), fade);
      gl.uniform3fv(uniform("grey"), colour("#b4b4b0")), gl.uniform3fv(uniform("paper"), colour(look.paper));
      gl.bindVertexArray(this.discArray);
      for (let location = 0; location < 5; ++location) gl.vertexAttribDivisor(location, points ? 0 : 1);
      if (points) gl.drawArrays(gl.POINTS, 0, this.count);
      else gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.count);
    }
    if (this.segmentCount > 0) {
      const { program, uniform } = this.segments;
      gl.useProgram(program);
      gl.disable(gl.DEPTH_TEST), gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE), gl.enable(gl.BLEND);
      gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
      gl.uniform4fv(uniform("window"), window), gl.uniform2f(uniform("size"), width / 2, height / 2);
      gl.uniform3fv(uniform("ink"), colour(look.ink));
      gl.bindVertexArray(this.segmentArray);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.segmentCount);
    }
  }
}

/** The colour of a segment from its red, green, blue and 255, or 0 for that of all lines. */
const inkOf = (tint, i, look) => (tint[4 * i + 3] > 0 ? rgb([...tint.subarray(4 * i, 4 * i + 3)]) : look.ink);

/** Lines, circles and text on a canvas. Lengths in CSS pixels. */
class CanvasPen {
  constructor(context) {
    this.context = context;
    this.font = getComputedStyle(document.body).fontFamily;
  }
  line(x1, y1, x2, y2, colour, width, alpha = 1) {
    const c = this.context;
    c.globalAlpha = alpha, c.strokeStyle = colour, c.lineWidth = width, c.lineCap = "round";
    c.beginPath(), c.moveTo(x1, y1), c.lineTo(x2, y2), c.stroke();
    c.globalAlpha = 1;
  }
  disc(x, y, radius, fill, rim) {
    const c = this.context;
    c.fillStyle = fill, c.beginPath(), c.arc(x, y, radius, 0, 2 * Math.PI), c.fill();
    if (radius > 2) c.strokeStyle = rim, c.lineWidth = 0.7, c.stroke();
  }
  box(x, y, width, height, fill) {
    this.context.fillStyle = fill;
    this.context.fillRect(x, y, width, height);
  }
  text(x, y, words, colour, anchor = "start", size = 12, upwards = false, weight = 400) {
    const c = this.context;
    c.fillStyle = colour, c.font = `${weight} ${size}px ${this.font}`, c.textAlign = anchor === "middle" ? "center" : anchor;
    c.save(), c.translate(x, y);
    if (upwards) c.rotate(-Math.PI / 2);
    c.fillText(words, 0, 0);
    c.restore();
  }
  /** A canvas, without smoothing. */
  image(canvas, x, y, width, height) {
    this.context.imageSmoothingEnabled = false;
    this.context.drawImage(canvas, x, y, width, height);
  }
  /** Clips what `draw` draws to a box. */
  within(box, draw) {
    const c = this.context;
    c.save(), c.beginPath(), c.rect(...box), c.clip();
    draw();
    c.restore();
  }
}

/** The same as SVG. */
class SvgPen {
  constructor(width, height, paper) {
    this.parts = [`<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" ` +
      `font-family="Helvetica, Arial, sans-serif"><rect width="100%" height="100%" fill="${paper}"/>`];
  }
  line(x1, y1, x2, y2, colour, width, alpha = 1) {
    const n = SvgPen.number;
    this.parts.push(`<line x1="${n(x1)}" y1="${n(y1)}" x2="${n(x2)}" y2="${n(y2)}" stroke="${colour}" stroke-width="${n(width)}" stroke-opacity="${n(alpha)}" stroke-linecap="round"/>`);
  }
  disc(x, y, radius, fill, rim) {
    const n = SvgPen.number;
    this.parts.push(`<circle cx="${n(x)}" cy="${n(y)}" r="${n(radius)}" fill="${fill}" stroke="${rim}" stroke-width=".6"/>`);
  }
  box(x, y, width, height, fill) {
    const n = SvgPen.number;
    this.parts.push(`<rect x="${n(x)}" y="${n(y)}" width="${n(width)}" height="${n(height)}" fill="${fill}"/>`);
  }
  text(x, y, words, colour, anchor = "start", size = 12, upwards = false, weight = 400) {
    const safe = words.replaceAll("&", "&amp;").replaceAll("<", "&lt;"), at = `${SvgPen.number(x)} ${SvgPen.number(y)}`;
    this.parts.push(`<text transform="translate(${at})${upwards ? " rotate(-90)" : ""}" fill="${colour}" text-anchor="${anchor}" font-size="${size}" font-weight="${weight}">${safe}</text>`);
  }
  /** A canvas, without smoothing. */
  image(canvas, x, y, width, height) {
    const n = SvgPen.number;
    this.parts.push(`<image x="${n(x)}" y="${n(y)}" width="${n(width)}" height="${n(height)}" preserveAspectRatio="none" style="image-rendering:pixelated" href="${canvas.toDataURL()}"/>`);
  }
  /** Clips what `draw` draws to a box. */
  within([x, y, width, height], draw) {
    this.parts.push(`<clipPath id="panel"><rect x="${x}" y="${y}" width="${width}" height="${height}"/></clipPath><g clip-path="url(#panel)">`);
    draw();
    this.parts.push("</g>");
  }
  static number(value) {
    return +value.toFixed(2);
  }
  finish() {
    return this.parts.join("\n") + "\n</svg>\n";
  }
}
