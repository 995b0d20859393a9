// Drawings in space: three.js from the data that stand beside each. Nothing is fetched.
"use strict";
(() => {
  const root = document.documentElement;
  const css = (name) => getComputedStyle(root).getPropertyValue("--" + name).trim();
  const buffer = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;
  const floats = (text) => new Float32Array(buffer(text));
  const palette = ["Regulator", "Chamber1", "Chamber2", "Estimate", "Band"];
  const element = (name, attributes = {}, ...children) => {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.append(...children);
    return made;
  };
  const hex = (shade) => "#" + shade.map((value) => value.toString(16).padStart(2, "0")).join("");
  // Widths of lines, and of what of them a pointer meets [px].
  const [WIDTH, PICKED, REACH, COARSE] = [3.5, 6, 14, 26];
  const MARGIN = 40;
  // Bodies lie back by half a line's width, so that of lines on their edges the whole width is seen.
  const back = (ratio) => ({ polygonOffset: true, polygonOffsetFactor: 5 * ratio, polygonOffsetUnits: 4 });

  const drawings = [];

  // Data of a line, ready to be drawn: its segments, and the length up to each.
  const unpacked = (line, which) => {
    const points = floats(line.points);
    const segments = points.length / 3 - 1;
    const pairs = new Float32Array(6 * segments);
    const stations = [0];
    for (let i = 0; i < segments; i += 1) {
      pairs.set(points.subarray(3 * i, 3 * i + 6), 6 * i);
      stations.push(stations[i] + Math.hypot(...[0, 1, 2].map((axis) => points[3 * i + 3 + axis] - points[3 * i + axis])));
    }
    return { ...line, which, points, segments, pairs, stations, length: stations[segments], values: floats(line.values), outward: new THREE.Vector3(...line.outward) };
  };
  // Place and direction at a length along a line.
  const along = (line, station) => {
    let i = 0;
    while (i < line.segments - 1 && line.stations[i + 1] < station) i += 1;
    const [from, to] = [new THREE.Vector3().fromArray(line.points, 3 * i), new THREE.Vector3().fromArray(line.points, 3 * i + 3)];
    const share = (station - line.stations[i]) / Math.max(line.stations[i + 1] - line.stations[i], 1e-9);
    return { at: from.clone().lerp(to, share), along: to.sub(from).normalize() };
  };

  class Space {
    constructor(place) {
      this.place = place;
      this.content = JSON.parse(place.querySelector("script").textContent);
      this.view = 0;
      this.picked = null;
      this.hovered = null;
      this.labels = [];
    }

    build() {
      const canvas = element("canvas");
      const context = canvas.getContext("webgl2", { antialias: true, alpha: true, powerPreference: "default" });
      if (!context) {
        this.place.prepend(element("p", { class: "hint" }, "This browser does not draw in 3D (WebGL 2 is off or missing): here is a picture instead."));
        return;
      }
      this.frame(canvas);
      this.renderer = new THREE.WebGLRenderer({ canvas, context, antialias: true, alpha: true });
      this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
      this.scene = new THREE.Scene();
      this.camera = new THREE.OrthographicCamera();
      this.camera.up.set(0, 0, 1);
      const sky = new THREE.HemisphereLight(0xffffff, 0x707880, 2.3);
      sky.position.set(0, 0, 1);
      this.scene.add(sky);
      const lamp = new THREE.DirectionalLight(0xffffff, 1.9);
      lamp.position.set(-0.7, 0.5, 0.8);
      this.camera.add(lamp);
      this.scene.add(this.camera);
      this.lines = this.content.lines.map(unpacked);
      this.bodies = this.content.bodies.map((body) => this.body(body));
      this.build_lines();
      this.marks();
      this.steer();
      this.listen();
      this.rows();
      this.paint();
      new ResizeObserver(() => this.resize()).observe(this.stage);
      this.resize();
      this.look(0);
    }

    // What stands around the canvas.
    frame(canvas) {
      const { content, place } = this;
      place.classList.add("live");
      this.canvas = canvas;
      const name = `${content.name}. Arrow keys turn it, plus and minus zoom, 0 shows all again.`;
      Object.entries({ tabindex: "0", role: "application", "aria-label": name }).forEach(([key, value]) => canvas.setAttribute(key, value));
      this.over = element("div", { class: "over" });
      this.tip = element("div", { class: "tip", hidden: "" });
      this.bar = element("div", { class: "bar" }, element("i"), element("span"));
      this.triad = element("div", { class: "triad", role: "img", "aria-label": "axes x, y, z" });
      this.stage = element("div", { class: "stage" }, this.canvas, this.over, this.triad, this.bar, this.tip);
      this.buttons = content.views.map((view, which) => {
        const button = element("button", { type: "button" }, view.name);
        button.addEventListener("click", () => { this.pick(null); this.look(which); });
        return button;
      });
      const reset = element("button", { type: "button", class: "reset" }, "Reset view");
      reset.addEventListener("click", () => this.look(this.view));
      const how = element("span", { class: "how" }, matchMedia("(pointer: coarse)").matches ? "One finger turns, two move and zoom, a tap picks." : "Drag turns, right drag moves, the wheel zooms once the drawing is clicked.");
      this.tools = element("div", { class: "tools" }, ...(content.views.length > 1 ? this.buttons : []), reset, how);
      const parts = [this.tools, this.stage];
      this.shades = element("div", { class: "shades-of-view" });
      if (content.legend) parts.push(this.shades);
      if (content.words) parts.push(element("p", { class: "hint" }, content.words));
      if (content.lines.some((line) => line.lines || line.remark)) {
        this.panel = element("aside", { class: "panel", "aria-live": "polite" });
        parts.push(this.panel);
        place.classList.add("picks");
      }
      place.prepend(...parts);
      this.tell();
    }

    legend({ title, ends, shades, none }) {
      const bar = element("i", { class: "shades" });
      bar.style.background = `linear-gradient(to right, ${shades.map(hex).join(", ")})`;
      const legend = element("div", { class: "legend" }, element("b", {}, title), element("div", {}, bar, element("span", {}, ...ends.map((end) => element("span", {}, end)))));
      if (none) {
        const swatch = element("i", { class: "swatch" });
        swatch.style.background = hex(none[0]);
        legend.append(element("span", {}, swatch, " " + none[1]));
      }
      return legend;
    }

    body(content) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(floats(content.corners), 3));
      const triangles = new Uint32Array(buffer(content.triangles));
      geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
      // Faces that meet at a sharp edge do not share corners.
      geometry.computeVertexNormals();
      const material = new THREE.MeshLambertMaterial(content.shade ? {} : back(this.renderer.getPixelRatio()));
      const mesh = new THREE.Mesh(geometry, material);
      mesh.layers.enable(1);
      mesh.userData = { content, material };
      mesh.renderOrder = -2;
      this.scene.add(mesh);
      return mesh;
    }

    // Lines of a view are one object each: those for use, and pale ones; and once more, wide, in colours that number them, on a layer of their own.
    build_lines() {
      this.owners = [null];
      this.drawn = [];
      const views = new Set(this.lines.map((line) => line.view));
      for (const view of views) {
        for (const pale of [false, true]) {
          const lines = this.lines.filter((line) => line.view === view && line.pale === pale);
          if (lines.length === 0) continue;
          const pairs = new Float32Array(lines.reduce((sum, line) => sum + line.pairs.length, 0));
          const numbers = new Float32Array(pairs.length);
          let at = 0;
          for (const line of lines) {
            pairs.set(line.pairs, at);
            for (let i = 0; i < line.segments; i += 1) {
              const number = this.owners.push({ line, segment: i }) - 1;
              const colour = [number >> 16, (number >> 8) & 255, number & 255].map((value) => value / 255);
              numbers.set([...colour, ...colour], at + 6 * i);
            }
            at += 6 * line.segments;
          }
          const shaded = lines.some((line) => line.shades.length);
          if (shaded) this.drawn.push({ view, object: this.segments(pairs, { linewidth: WIDTH + 5, color: 0x222222 }, -1) });
          this.drawn.push({ view, pale, lines, object: this.segments(pairs, { linewidth: shaded ? WIDTH + 2 : WIDTH, vertexColors: true, dashed: pale, dashScale: 1 }) });
          const met = this.segments(pairs, { linewidth: REACH, vertexColors: true, depthWrite: true });
          met.geometry.setColors(numbers);
          met.layers.set(1);
          this.drawn.push({ view, object: met, met: true });
        }
      }
    }

    segments(pairs, options, order = 0) {
      const geometry = new THREE.LineSegmentsGeometry();
      geometry.setPositions(pairs);
      if (options.vertexColors) geometry.setColors(new Float32Array(pairs.length));
      const object = new THREE.LineSegments2(geometry, new THREE.LineMaterial({ depthWrite: false, ...options }));
      if (options.dashed) object.computeLineDistances();
      object.frustumCulled = false;
      object.renderOrder = order;
      this.scene.add(object);
      return object;
    }

    // Where a line begins and which way it goes, and the force: of one size on the screen.
    marks() {
      const dark = new THREE.MeshBasicMaterial({ transparent: true });
      const begin = () => {
        const [dot, cone] = [new THREE.Mesh(new THREE.SphereGeometry(1, 20, 12), dark), new THREE.Mesh(new THREE.ConeGeometry(0.9, 2.6, 20), dark)];
        dot.renderOrder = cone.renderOrder = 4;
        this.scene.add(dot, cone);
        return { dot, cone };
      };
      this.dark = dark;
      this.begin = begin();
      const { arrow } = this.content;
      if (!arrow) return;
      this.arrow = new THREE.Group();
      const paint = new THREE.MeshBasicMaterial({ depthTest: false });
      const head = new THREE.Mesh(new THREE.ConeGeometry(7, 18, 20), paint);
      head.position.y = -9;
      const shaft = this.segments(new Float32Array([0, -80, 0, 0, -14, 0]), { linewidth: 4, depthTest: false });
      head.renderOrder = shaft.renderOrder = 3;
      this.arrow.add(head, shaft);
      this.arrow.userData = { paints: [paint, shaft.material] };
      this.arrow.position.fromArray(arrow.at);
      this.arrow.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), new THREE.Vector3(...arrow.along));
      this.scene.add(this.arrow);
    }

    steer() {
      this.controls = new THREE.OrbitControls(this.camera, this.canvas);
      this.controls.zoomToCursor = true;
      this.controls.addEventListener("change", () => this.ask());
      // A page is scrolled over a drawing that nobody has turned to.
      this.controls.enableZoom = false;
      const turned = (to) => { this.controls.enableZoom = to; };
      this.canvas.addEventListener("pointerdown", () => { turned(true); this.canvas.focus({ preventScroll: true }); }, { capture: true });
      this.canvas.addEventListener("focus", () => turned(true));
      this.canvas.addEventListener("blur", () => turned(false));
      const keys = {
        ArrowLeft: () => this.controls.rotateLeft(0.2), ArrowRight: () => this.controls.rotateLeft(-0.2),
        ArrowUp: () => this.controls.rotateUp(0.2), ArrowDown: () => this.controls.rotateUp(-0.2),
        "+": () => this.controls.dollyIn(0.8), "-": () => this.controls.dollyOut(0.8), "0": () => this.look(this.view),
      };
      this.canvas.addEventListener("keydown", (event) => {
        const act = keys[event.key === "=" ? "+" : event.key];
        if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
        event.preventDefault();
        act();
      });
    }

    listen() {
      const at = (event) => {
        const box = this.canvas.getBoundingClientRect();
        return [event.clientX - box.left, event.clientY - box.top];
      };
      let pressed = null;
      this.canvas.addEventListener("pointerdown", (event) => { pressed = event.isPrimary ? { at: at(event), time: event.timeStamp } : null; this.hover(null); });
      this.canvas.addEventListener("pointerup", (event) => {
        if (!pressed) return;
        const [x, y] = at(event);
        const still = Math.hypot(x - pressed.at[0], y - pressed.at[1]) < 6 && event.timeStamp - pressed.time < 600;
        pressed = null;
        if (!still) return;
        const found = this.near([x, y], event.pointerType === "mouse" ? 0 : COARSE / 2);
        if (found) this.pick(found.line);
        if (found && event.pointerType !== "mouse") this.hover(found, [x, y]);
      });
      this.canvas.addEventListener("pointermove", (event) => {
        if (event.pointerType === "touch" || event.buttons) return;
        const place = at(event);
        this.hover(this.near(place, 0), place);
      });
      this.canvas.addEventListener("pointerleave", (event) => { if (event.pointerType !== "touch") this.hover(null); });
      this.canvas.addEventListener("webglcontextlost", () => this.place.classList.remove("live"));
      this.canvas.addEventListener("webglcontextrestored", () => { this.place.classList.add("live"); this.ask(); });
    }

    // Rows of the section's table that name a line pick it.
    rows() {
      this.row = new Map();
      if (!this.panel) return;
      for (const row of this.place.closest("section").querySelectorAll("tbody tr")) {
        const cell = row.cells[0];
        const line = this.lines.find((one) => one.id === cell.textContent);
        if (!line) continue;
        const button = element("button", { type: "button", class: "pick" }, cell.textContent);
        cell.replaceChildren(button);
        row.addEventListener("click", () => {
          this.pick(line);
          this.show(line);
          this.stage.scrollIntoView({ block: "nearest" });
        });
        this.row.set(line, row);
      }
    }

    // Colours of the page's theme.
    paint() {
      const colour = (name) => new THREE.Color(css(name));
      for (const mesh of this.bodies) {
        const { content, material } = mesh.userData;
        material.color = content.shade ? new THREE.Color(hex(content.shade)) : colour("part");
      }
      for (const { object, lines, pale } of this.drawn) {
        if (!lines) continue;
        const colours = [];
        for (const line of lines) {
          for (let i = 0; i < line.segments; i += 1) {
            const { r, g, b } = line.shades.length ? new THREE.Color(hex(line.shades[i])) : this.colour(line);
            colours.push(r, g, b, r, g, b);
          }
        }
        object.geometry.setColors(colours);
        object.material.opacity = pale ? 0.7 : 1;
        object.material.transparent = pale;
      }
      this.dark.color = colour("ink");
      this.arrow?.userData.paints.forEach((paint) => { paint.color = colour("Force"); });
      this.mark();
      this.ask();
    }

    colour(line) { return new THREE.Color(css(line.pale ? "quiet" : palette[line.colour % palette.length])); }

    shown(thing) { return thing.view === null || thing.view === this.view; }

    // A view, as it begins.
    look(which, eye = this.content.views[which].eye) {
      this.view = which;
      this.buttons.forEach((button, at) => button.setAttribute("aria-pressed", String(at === which)));
      for (const mesh of this.bodies) mesh.visible = this.shown(mesh.userData.content);
      // A line with a meaning of its own stands alone.
      const own = this.lines.find((line) => line.legend && line.view === which);
      for (const one of this.drawn) one.object.visible = this.shown(one) && !(own && one.view === null);
      const legend = own?.legend ?? this.content.legend;
      if (legend) this.shades.replaceChildren(this.legend(legend));
      if (this.arrow) this.arrow.visible = this.shown(this.content.arrow);
      const meshes = this.bodies.filter((mesh) => mesh.visible);
      const towards = new THREE.Vector3(...eye).normalize();
      const right = new THREE.Vector3(0, 0, 1).cross(towards);
      if (right.lengthSq() < 1e-6) right.set(1, 0, 0);
      right.normalize();
      const frame = [right, towards.clone().cross(right), towards];
      const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
      const point = new THREE.Vector3();
      for (const mesh of meshes) {
        const { array } = mesh.geometry.attributes.position;
        for (let i = 0; i < array.length; i += 3) {
          point.fromArray(array, i);
          frame.forEach((axis, a) => { const v = axis.dot(point); low[a] = Math.min(low[a], v); high[a] = Math.max(high[a], v); });
        }
      }
      const size = high.map((value, a) => value - low[a]);
      const reach = Math.hypot(...size);
      const middle = frame.reduce((sum, axis, a) => sum.addScaledVector(axis, 0.5 * (low[a] + high[a])), new THREE.Vector3());
      this.controls.target.copy(middle);
      this.camera.position.copy(middle).addScaledVector(towards, 2 * reach);
      [this.camera.near, this.camera.far] = [0, 4 * reach];
      const [width, height] = this.size;
      this.fit = Math.min((width - 2 * MARGIN) / size[0], (height - 2 * MARGIN) / size[1]);
      this.camera.zoom = this.fit;
      [this.controls.minZoom, this.controls.maxZoom] = [0.3 * this.fit, 60 * this.fit];
      this.camera.updateProjectionMatrix();
      this.controls.update();
      for (const { object, pale } of this.drawn) if (pale) object.material.dashSize = object.material.gapSize = 5 / this.fit;
      this.mark();
      this.ask();
    }

    // Turned so that a line is seen.
    show(line) {
      if (line.view !== null && line.view !== this.view) this.look(line.view);
      if (this.samples(line).some((sample) => this.seen(line, sample))) return;
      const eye = line.outward.clone().multiplyScalar(1.2).add(new THREE.Vector3(...this.content.views[this.view].eye).normalize().multiplyScalar(0.5));
      this.look(this.view, eye.toArray());
    }

    resize() {
      const [width, height] = [this.stage.clientWidth, this.stage.clientHeight];
      if (!width || !height) return;
      const before = this.size;
      this.size = [width, height];
      this.renderer.setSize(width, height, false);
      this.target?.dispose();
      this.target = new THREE.WebGLRenderTarget(width, height);
      Object.assign(this.camera, { left: -width / 2, right: width / 2, top: height / 2, bottom: -height / 2 });
      this.camera.updateProjectionMatrix();
      if (before && (before[0] !== width || before[1] !== height)) this.look(this.view);
    }

    ask() {
      this.stale = true;
      if (this.asked) return;
      this.asked = true;
      requestAnimationFrame(() => { this.asked = false; this.draw(); });
    }

    draw() {
      const size = 1 / this.camera.zoom;
      this.begin.dot.scale.setScalar(5 * size);
      this.begin.cone.scale.setScalar(7 * size);
      if (this.begin.dot.visible) {
        // Clear of the dot.
        const { line, cone } = this.begin;
        const on = along(line, Math.min(Math.max(0.05 * line.length, 26 * size), 0.6 * line.length));
        cone.position.copy(on.at);
        cone.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), on.along);
      }
      this.arrow?.scale.setScalar(size);
      this.renderer.render(this.scene, this.camera);
      this.overlay();
      clearTimeout(this.later);
      this.later = setTimeout(() => this.label(), 60);
    }

    // Numbers of segments as they are seen, 0 where there is none: what a pointer meets, and what is not hidden.
    numbers() {
      const [width, height] = this.size;
      if (this.stale || !this.seenNumbers) {
        const black = (this.black ??= new THREE.MeshBasicMaterial({ color: 0, ...back(1) }));
        for (const mesh of this.bodies) mesh.material = black;
        this.camera.layers.set(1);
        this.renderer.setRenderTarget(this.target);
        this.renderer.render(this.scene, this.camera);
        this.seenNumbers = new Uint8Array(4 * width * height);
        this.renderer.readRenderTargetPixels(this.target, 0, 0, width, height, this.seenNumbers);
        this.renderer.setRenderTarget(null);
        this.camera.layers.set(0);
        for (const mesh of this.bodies) mesh.material = mesh.userData.material;
        this.stale = false;
      }
      return this.seenNumbers;
    }

    at(x, y) {
      const [width, height] = this.size;
      const [column, line] = [Math.floor(x), Math.floor(height - y)];
      if (column < 0 || line < 0 || column >= width || line >= height) return null;
      const at = 4 * (column + width * line);
      const numbers = this.numbers();
      return this.owners[(numbers[at] << 16) | (numbers[at + 1] << 8) | numbers[at + 2]] ?? null;
    }

    // The line at a place, by its number or itself, or at most so far from it [px].
    near([x, y], reach) {
      const label = this.labels.find(({ box }) => box && x >= box[0] && x <= box[2] && y >= box[1] && y <= box[3]);
      if (label) return { line: label.line };
      for (let radius = 0; radius <= reach; radius += 3) {
        const turns = radius === 0 ? 1 : 12;
        for (let turn = 0; turn < turns; turn += 1) {
          const angle = (2 * Math.PI * turn) / turns;
          const found = this.at(x + radius * Math.cos(angle), y + radius * Math.sin(angle));
          if (found) return found;
        }
      }
      return null;
    }

    project(point) {
      const [width, height] = this.size;
      const seen = point.clone().project(this.camera);
      return [0.5 * (seen.x + 1) * width, 0.5 * (1 - seen.y) * height];
    }

    seen(line, sample) { return this.at(...this.project(sample))?.line === line; }

    // Places on a line, from its middle outwards; the middle of an outline would be a corner of most.
    samples(line) {
      const count = 25;
      line.samples ??= Array.from({ length: count }, (_, i) => {
        const step = Math.ceil(i / 2) * (i % 2 ? 1 : -1);
        const share = (line.id.startsWith("loop") ? 0.375 : 0.5) + (0.92 * step) / count;
        return along(line, line.length * (share < 0 ? share + 1 : share)).at;
      });
      return line.samples;
    }

    // Where numbers stand: on what is seen of their lines, none on another.
    label() {
      const order = [...this.lines].sort((a, b) => (b === this.picked) - (a === this.picked) || a.pale - b.pale || b.length - a.length);
      this.labels = [];
      const taken = [];
      for (const line of order) {
        if (!line.label || !this.shown(line) || this.labels.length >= 80) continue;
        const half = [6 + 4 * line.label.length, 10];
        const aside = this.aside(line);
        for (const sample of this.samples(line)) {
          const [x, y] = this.project(sample).map((value, axis) => value + aside[axis]);
          const box = [x - half[0], y - half[1], x + half[0], y + half[1]];
          const inside = box[0] > 0 && box[1] > 0 && box[2] < this.size[0] && box[3] < this.size[1];
          if (!inside || taken.some((other) => box[0] < other[2] && box[2] > other[0] && box[1] < other[3] && box[3] > other[1]) || !this.seen(line, sample)) continue;
          taken.push(box);
          const chip = element("span", { class: "number" + (line === (this.hovered ?? this.picked) ? " picked" : "") + (line.pale ? " pale" : "") }, line.label);
          chip.style.borderColor = css(line.pale ? "quiet" : palette[line.colour % palette.length]);
          this.labels.push({ line, sample, chip, aside });
          break;
        }
      }
      this.over.replaceChildren(...this.labels.map(({ chip }) => chip), ...this.words());
      this.overlay();
    }

    // From a line to its number [px]: away from the part, but not from an outline, which lies within its face.
    aside(line) {
      if (line.id.startsWith("loop")) return [0, 0];
      const { x, y } = line.outward.clone().applyQuaternion(this.camera.quaternion.clone().invert());
      const length = Math.hypot(x, y);
      return length > 0.2 ? [(15 * x) / length, (-15 * y) / length] : [0, 0];
    }

    // Words beside marks: the start's away from the middle of its line, which it would hide.
    words() {
      const made = [];
      const word = (at, text, aside = [0, -18]) => {
        const chip = element("span", { class: "word" }, text);
        this.labels.push({ sample: at, chip, aside });
        made.push(chip);
      };
      if (this.begin.dot.visible) {
        const at = this.begin.dot.position;
        const samples = this.samples(this.begin.line).map((sample) => this.project(sample));
        const middle = [0, 1].map((axis) => samples.reduce((sum, place) => sum + place[axis], 0) / samples.length);
        const away = this.project(at).map((value, axis) => value - middle[axis]);
        const length = Math.hypot(...away);
        word(at, "start", length > 1 ? [(32 * away[0]) / length, (20 * away[1]) / length] : undefined);
      }
      const { arrow } = this.content;
      if (arrow && this.arrow.visible) word(() => this.arrow.localToWorld(new THREE.Vector3(0, -84, 0)), arrow.label);
      return made;
    }

    // What lies over the canvas moves with it.
    overlay() {
      for (const label of this.labels) {
        const place = this.project(typeof label.sample === "function" ? label.sample() : label.sample);
        // Words stay within the drawing, whole.
        const half = label.line ? [0, 0] : [label.chip.offsetWidth / 2 + 2, label.chip.offsetHeight / 2 + 2];
        const within = (value, axis) => label.line ? value : Math.min(Math.max(value, half[axis]), this.size[axis] - half[axis]);
        const [x, y] = place.map((value, axis) => within(value + label.aside[axis], axis));
        label.chip.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)`;
        if (label.line) label.box = [x - 6 - 4 * label.line.label.length, y - 10, x + 6 + 4 * label.line.label.length, y + 10];
      }
      const longest = 0.25 * this.size[0] / this.camera.zoom;
      const decade = 10 ** Math.floor(Math.log10(longest));
      const length = [5, 2, 1].map((step) => step * decade).find((one) => one <= longest);
      this.bar.firstChild.style.width = `${length * this.camera.zoom}px`;
      this.bar.lastChild.textContent = `${Number(length.toPrecision(1))} mm`;
      const axes = [["x", "bad"], ["y", "good"], ["z", "link"]].map(([name, colour], axis) => {
        const end = new THREE.Vector3().setComponent(axis, 1).applyQuaternion(this.camera.quaternion.clone().invert());
        return { name, colour, end };
      });
      axes.sort((a, b) => a.end.z - b.end.z);
      this.triad.innerHTML = `<svg viewBox="-40 -40 80 80">${axes.map(({ name, colour, end }) => `<line x2="${(26 * end.x).toFixed(1)}" y2="${(-26 * end.y).toFixed(1)}" style="stroke: var(--${colour})"/><text x="${(34 * end.x).toFixed(1)}" y="${(-34 * end.y + 4.5).toFixed(1)}" style="fill: var(--${colour})">${name}</text>`).join("")}</svg>`;
    }

    hover(found, place) {
      const line = found?.line ?? null;
      if (line !== this.hovered) {
        this.hovered = line;
        this.canvas.style.cursor = line ? "pointer" : "";
        // What was shown last stays: on the way to it the pointer leaves the line.
        if (line || this.picked) this.tell();
        this.mark();
        this.ask();
      }
      this.tip.hidden = !line;
      if (!line) return;
      this.tip.replaceChildren(...this.brief(found));
      const [width, height] = [this.tip.offsetWidth, this.tip.offsetHeight];
      const x = Math.min(Math.max(place[0] + 14, 4), this.size[0] - width - 4);
      const y = place[1] + 18 + height < this.size[1] ? place[1] + 18 : place[1] - height - 12;
      this.tip.style.transform = `translate(${x}px, ${y}px)`;
    }

    brief({ line, segment }) {
      const rows = [element("b", {}, line.id)];
      const legend = line.legend ?? this.content.legend;
      if (segment !== undefined && line.values.length && legend) {
        const value = line.values[segment];
        const from = 0.5 * (line.stations[segment] + line.stations[segment + 1]);
        const content = Number.isFinite(value) ? `${legend.unsigned ? "" : value < 0 ? "−" : "+"}${Math.abs(value).toPrecision(3)} ${legend.unit}` : legend.none?.[1] ?? "–";
        rows.push(element("span", {}, `at ${from.toFixed(1)} mm: ${legend.title} ${content}`));
        return rows;
      }
      rows.push(element("span", {}, line.facts.slice(0, 2).map(([, value]) => value).join(", ")));
      if (line.remark) rows.push(element("span", {}, line.remark));
      if (line.lines) rows.push(element("code", {}, line.lines.split("\n").filter((one) => one && !one.startsWith("#")).join("\n")));
      return rows;
    }

    pick(line) {
      if (!this.panel) return;
      this.row.get(this.picked)?.classList.remove("picked");
      this.picked = line;
      this.row.get(line)?.classList.add("picked");
      this.tell();
      this.mark();
      this.ask();
    }

    // The line that is looked at: wide, and where it is hidden still to be seen.
    mark() {
      for (const object of this.marked ?? []) { this.scene.remove(object); object.geometry.dispose(); object.material.dispose(); }
      this.marked = [];
      const line = this.panel ? this.hovered ?? this.picked : this.lines[0];
      this.begin.dot.visible = this.begin.cone.visible = Boolean(line && this.shown(line));
      if (!line || !this.shown(line)) return;
      this.begin.line = line;
      this.begin.dot.position.copy(along(line, 0).at);
      if (!this.panel) return;
      const add = (options, order) => this.marked.push(this.segments(line.pairs, options, order));
      add({ linewidth: PICKED + 4, color: css("ink") }, 1);
      add({ linewidth: PICKED, color: this.colour(line) }, 2);
      add({ linewidth: PICKED, color: this.colour(line), depthTest: false, transparent: true, opacity: 0.35 }, 3);
    }

    tell() {
      if (!this.panel) return;
      const line = this.hovered ?? this.picked;
      if (!line) {
        this.panel.replaceChildren(element("p", {}, "Point at an edge, or pick one here or in the table: its numbers and its lines for a scenario stand here."));
        return;
      }
      const facts = line.facts.map(([name, value]) => element("div", {}, element("dt", {}, name), element("dd", {}, value)));
      const parts = [element("h3", {}, line.id), element("dl", {}, ...facts)];
      if (line.remark) parts.push(element("p", { class: "remark" }, line.remark));
      if (line.lines) parts.push(element("pre", {}, line.lines.trimEnd()), this.copier(line.lines));
      this.panel.replaceChildren(...parts);
    }

    copier(lines) {
      const button = element("button", { type: "button", class: "copy" }, "Copy lines");
      const done = (is) => { button.textContent = is ? "Copied" : "Select the lines and copy them"; };
      button.addEventListener("click", async () => {
        try {
          await navigator.clipboard.writeText(lines);
          done(true);
        } catch {
          // The older way, where a page from a file may not use the newer.
          const range = document.createRange();
          range.selectNodeContents(this.panel.querySelector("pre"));
          getSelection().removeAllRanges();
          getSelection().addRange(range);
          done(document.execCommand("copy"));
        }
      });
      return button;
    }
  }

  // The library is unpacked once a drawing is near: numbers and charts of the page do not wait for it.
  let library = null;
  const loaded = () => {
    library ??= (async () => {
      const packed = new Blob([buffer(document.getElementById("space-library").textContent)]);
      const text = await new Response(packed.stream().pipeThrough(new DecompressionStream("gzip"))).text();
      document.head.append(element("script", {}, text));
    })();
    return library;
  };
  const places = [...document.querySelectorAll("div.space")];
  for (const place of places) drawings.push(new Space(place));
  const watch = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries) {
      if (!isIntersecting) continue;
      watch.unobserve(target);
      loaded().then(() => drawings.find((one) => one.place === target).build());
    }
  }, { rootMargin: "400px" });
  for (const place of places) watch.observe(place);
  new MutationObserver(() => drawings.forEach((one) => one.renderer && (one.paint(), one.label()))).observe(root, { attributes: true, attributeFilter: ["data-theme"] });
  // For tests: what is drawn.
  window.idcDrawings = drawings;
})();
