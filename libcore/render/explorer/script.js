// The explorer of a frame's pixels: a picture, the rays of one or two of its pixels as words, and the same rays in space among the
// bodies as lines. Of explorer.h's data; pixels' rays come from the page itself or, in a notebook, from the kernel.
const KINDS = ["primary", "mirrored", "transmitted"], [SURFACE, LIGHT, BACKGROUND, PRUNED] = [0, 1, 2, 3];

const BODY = `<header><h1>Why a pixel is what it is</h1><p class="about"></p></header>
<div class="views">
<figure><div class="stage"><img alt="the picture"><canvas class="marks" tabindex="0" role="application" aria-label="the picture: click a pixel, or walk with the arrow keys"></canvas></div>
<figcaption><span>Click a pixel, or walk with the arrow keys.</span><span class="grid"></span></figcaption></figure>
<figure><div class="stage"><canvas class="space" tabindex="0" role="application" aria-label="the rays in space: drag or arrow keys turn, plus and minus zoom, 0 is the camera's own view"></canvas></div>
<figcaption><span><i class="key primary"></i>from the camera</span><span><i class="key mirrored"></i>mirrored</span><span><i class="key transmitted"></i>transmitted</span>
<label><input type="checkbox" class="to-lights"> <i class="key dashed light"></i>to lights</label><button class="home end" title="Drag turns it; once it is clicked, the wheel zooms">the camera's view</button></figcaption></figure>
</div>
<div class="controls"><label>depth <input type="range" class="depth" min="1" step="1"><output></output></label>
<span class="lights" role="group" aria-label="lights"></span>
<label class="end">rays that bring at least <select class="least"><option value="0">0 %</option><option value=".001">0.1 %</option><option value=".005" selected>0.5 %</option>
<option value=".02">2 %</option><option value=".1">10 %</option></select></label><button class="compare" aria-pressed="false">a second pixel</button></div>
<div class="pixels"></div>`;

// Vectors and colors are arrays of three.
const add = (a, b, s = 1) => a.map((x, i) => x + s * b[i]), scaled = (a, s) => a.map(x => x * s), total = a => a[0] + a[1] + a[2];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const color = c => typeof c === "number" ? [c, c, c] : c, black = () => [0, 0, 0];
const short = x => Number(x.toPrecision(3)).toString(), percent = x => short(100 * x) + " %";
const numbers = c => c.every(x => short(x) === short(c[0])) ? short(c[0]) : c.map(short).join(" ");
const escaped = s => String(s).replace(/[&<>"]/g, c => ({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"})[c]);
const srgb = x => Math.round(255 * Math.min(1, Math.max(0, x <= .0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - .055)));
const css = c => `rgb(${c.map(srgb)})`, swatch = c => `<i class="swatch" style="background:${css(c)}"></i>`;

/** The rays of a pixel, parents first, from the camera at (0, 0, 0). */
function rays(list, span) {
  const all = [];
  for (const [parent, kind, end, weight, adds, ledger, lights, at, what, surface] of list) {
    const above = all[parent], start = above ? above.finish : black();
    all.push({above, kind, end, what, start, level: above ? above.level + 1 : 0, weight: color(weight), adds: color(adds), ledger: color(ledger),
      lights: lights.map(([light, adds, through]) => ({light, adds: color(adds), through})), finish: end === BACKGROUND ? add(start, at, .4 * span) : at,
      surface: surface && Object.fromEntries(["crossing", "material", "angle", "local", "mirrored", "through", "before", "beyond", "bent"].map((name, i) => [name, surface[i]]))});
  }
  return all;
}

/** What each ray brings at this depth with these lights off, and what may be missing: of itself and of all below it. */
function weigh(tree, data, depth, off) {
  for (const r of tree) {
    r.unfollowed = r.end >= PRUNED || r.level >= depth;
    r.missing = r.level > depth ? black() : r.unfollowed ? r.end >= PRUNED && r.level < depth ? r.ledger : r.weight.map((w, c) => w * data.bound[c]) : black();
    const dark = r.unfollowed || r.end === LIGHT && off.has(data.visible[r.what].group);
    r.brings = dark ? black() : r.lights.reduce((sum, l) => off.has(data.lights[l.light].group) ? sum : add(sum, l.adds), r.adds);
  }
  for (const r of tree.slice().reverse()) if (r.above) {
    r.above.brings = add(r.above.brings, r.brings);
    r.above.missing = add(r.above.missing, r.missing);
  }
  return {brings: tree[0].brings, missing: tree[0].missing};
}

/** A ray in words, as HTML. */
function words(r, data, off) {
  const limit = ` <small>could add ${numbers(r.missing)} at most</small>`, name = `<b>${escaped((r.end === LIGHT ? data.visible : data.objects)[r.what]?.name)}</b>`;
  if (r.unfollowed) return (r.end === PRUNED ? "too faint to be followed" : "beyond the depth") + limit;
  if (r.end === BACKGROUND) return "reaches the <b>background</b>";
  if (r.end === LIGHT) return `sees ${name}`;
  const s = r.surface, parts = [], through = color(s.through);
  if (s.mirrored > 0) parts.push(percent(s.mirrored) + " mirrored");
  if (total(through) > 0) parts.push((through.every(x => x === through[0]) ? percent(through[0]) : through.map(x => short(100 * x)).join(", ") + " %") + " transmitted");
  if (s.local > 0) parts.push(percent(s.local) + " its own");
  const how = [`${escaped(data.materials[s.material])}: ${parts.join(", ") || "black"}`];
  if (s.bent) how.push(s.bent < 0 ? "total reflection" : `bends to ${short(s.bent)}° (index ${s.before} → ${s.beyond})`);
  const lit = r.lights.filter(l => total(l.adds) > 0 && !off.has(data.lights[l.light].group)).sort((a, b) => total(b.adds) - total(a.adds));
  for (const l of lit.slice(0, 4)) how.push(`${escaped(data.lights[l.light].name)} adds ${numbers(l.adds)}` + behind(l, data, " through "));
  if (lit.length > 4) how.push(`${lit.length - 4} more lights`);
  for (const l of r.lights) if (total(l.adds) === 0) how.push(escaped(data.lights[l.light].name) + behind(l, data, " is in the shadow of "));
  return `${["meets", "enters", "leaves"][s.crossing]} ${name} at ${short(s.angle)}° <small>${how.join("; ")}</small>`;
}
const behind = (l, data, word) => l.through.length ? word + l.through.map(i => escaped(data.objects[i].name)).join(", ") : "";

/** Lines in space, seen by a camera that begins as the scene's own. */
class Space {
  constructor(canvas, data, picture) {
    Object.assign(this, {canvas, data, picture, g: canvas.getContext("2d")});
    this.home();
  }
  home() { Object.assign(this, {eye: black(), axes: this.data.axes, zoom: 1 / this.data.tan_half_width, own: true}); }
  turn(axis, angle, center) {
    const c = Math.cos(angle), s = Math.sin(angle);
    const turned = v => add(add(scaled(v, c), cross(axis, v), s), axis, dot(axis, v) * (1 - c));
    Object.assign(this, {eye: add(center, turned(add(this.eye, center, -1))), axes: this.axes.map(turned), own: false});
  }
  see(p) { const d = add(p, this.eye, -1); return this.axes.map(a => dot(d, a)); }
  place(v) { const w = this.canvas.width / 2; return [w + v[0] / v[2] * this.zoom * w, this.canvas.height / 2 - v[1] / v[2] * this.zoom * w]; }
  line(a, b, style, width, alpha = 1, dash = []) {
    let p = this.see(a), q = this.see(b);
    const near = 1e-3 * this.data.span;
    if (p[2] < near && q[2] < near) return;
    if (p[2] < near) p = add(p, add(q, p, -1), (near - p[2]) / (q[2] - p[2]));
    else if (q[2] < near) q = add(q, add(p, q, -1), (near - q[2]) / (p[2] - q[2]));
    Object.assign(this.g, {strokeStyle: style, lineWidth: width * devicePixelRatio, globalAlpha: alpha, lineCap: "round"});
    this.g.setLineDash(dash.map(x => x * devicePixelRatio));
    this.g.beginPath(); this.g.moveTo(...this.place(p)); this.g.lineTo(...this.place(q)); this.g.stroke();
  }
  dot(p, radius, style, label) {
    const v = this.see(p), g = this.g;
    if (v[2] < 1e-3 * this.data.span) return;
    const [x, y] = this.place(v), size = devicePixelRatio;
    Object.assign(g, {globalAlpha: 1, fillStyle: style});
    g.beginPath(); g.arc(x, y, radius * size, 0, 7); g.fill();
    if (!label) return;
    let top = y - 6 * size;
    while (this.labels.some(([a, b]) => Math.abs(a - x) < 90 * size && Math.abs(b - top) < 14 * size)) top += 5 * size;
    this.labels.push([x, top]);
    Object.assign(g, {font: `600 ${12 * size}px system-ui, sans-serif`, lineWidth: 3 * size, strokeStyle: this.of("card"), fillStyle: this.of("ink"), lineJoin: "round"});
    g.setLineDash([]);
    for (const text of ["strokeText", "fillText"]) g[text](label, x + 7 * size, top);
  }
  of(name) { return this.style.getPropertyValue("--" + name); }
  /** pixels: those whose rays are drawn, the last the strongest; hot: a ray whose way from the camera stands out. */
  draw(pixels, least, toLights, hot, off) {
    const {canvas, g, data} = this;
    this.style = getComputedStyle(canvas);
    this.labels = [];
    canvas.width = canvas.clientWidth * devicePixelRatio;
    canvas.height = canvas.clientHeight * devicePixelRatio;
    g.clearRect(0, 0, canvas.width, canvas.height);
    if (this.own) {  // the bodies are where the picture has them
      const w = canvas.width * this.zoom * data.tan_half_width, h = w * data.size[1] / data.size[0];
      g.globalAlpha = .28; g.drawImage(this.picture, (canvas.width - w) / 2, (canvas.height - h) / 2, w, h);
    }
    for (const body of data.bodies) for (const [a, b] of body) this.line(a, b, this.of("body"), 1, .6);
    for (const light of data.lights) if (!off.has(light.group)) this.dot(light.at, data.lights.length > 30 ? 2 : 4, this.of("light"));
    const way = new Set();
    for (let r = hot; r; r = r.above) way.add(r);
    for (const [i, tree] of pixels.entries()) this.tree(tree, least, i === pixels.length - 1 ? 1 : .3, toLights, way, hot, off);
  }
  tree(tree, least, alpha, toLights, way, hot, off) {
    const all = total(tree[0].brings) || 1, named = new Map();
    for (const r of tree) {
      const share = total(r.brings) / all, style = this.of(KINDS[r.kind]);
      if (r.unfollowed || r.above && share < least) continue;
      const faint = way.size && !way.has(r) ? .2 : 1;
      this.line(r.start, r.finish, style, way.has(r) ? 3.5 : 1 + 2.5 * Math.sqrt(Math.min(1, share)), alpha * faint);
      if (r.end === SURFACE && !named.has(r.what)) named.set(r.what, r.finish);
      if (alpha === 1 && (toLights && !way.size || r === hot)) for (const l of r.lights) if (total(l.adds) > 0 && !off.has(this.data.lights[l.light].group))
        this.line(r.finish, this.data.lights[l.light].at, this.of("light"), 1.3, .3 + .7 * Math.sqrt(Math.min(1, total(l.adds) / all)), [5, 4]);
    }
    if (alpha === 1) [...named].slice(0, 8).forEach(([object, at]) => this.dot(at, 3, this.of("primary"), this.data.objects[object].name));
  }
}

/** Fills `root`. ask(x, y): a promise of a pixel's rays, of which there are those in the middles of cells of `step` pixels. */
function explore(root, data, ask, linked) {
  root.innerHTML = BODY;
  const $ = name => root.querySelector(name), [width, height] = data.size, step = data.step, off = new Set();
  const picture = $("img"), marks = $(".marks"), grid = [Math.ceil(width / step), Math.ceil(height / step)];
  let pixels = [], active = 0, depth = data.depth, hot;
  data.objects = data.objects.map(name => ({name}));
  data.axes = data.axes.map(a => scaled(a, 1 / Math.hypot(...a)));
  const far = data.bodies.flat(2).map(p => Math.hypot(...p)).sort((a, b) => a - b);
  data.span = far[far.length >> 1] || 1;
  const groups = new Map();
  for (const light of [...data.lights, ...data.visible]) {
    light.group = light.place || light.name;
    groups.set(light.group, light.name.replace(/ edge \d+ light \d+$/, "'s edges"));
  }

  picture.src = "data:image/png;base64," + data.picture;
  for (const stage of root.querySelectorAll(".stage")) stage.style.aspectRatio = `${width} / ${height}`;
  $(".about").textContent = `${data.scene}, frame ${data.frame}, ${width} × ${height}, depth ${data.depth}, ${data.precision}; scene ${data.hash.slice(0, 12)}; Cistula ${data.version}`;
  $(".grid").textContent = (step > 1 ? `One pixel in ${step} × ${step} has its rays here: ${grid[0] * grid[1]} pixels.` : "")
    + (data.samples > 1 ? ` The picture has ${data.samples} samples a pixel; the rays are those through its middle.` : "");
  $(".lights").innerHTML = [...groups].map(([key, name]) => `<label><input type="checkbox" checked value="${escaped(key)}">${escaped(name)}</label>`).join("");
  const space = new Space($(".space"), data, picture), least = () => +$(".least").value;

  const draw = () => pixels.length && space.draw(pixels.map(p => p.tree).sort((a, b) => (a === pixels[active].tree) - (b === pixels[active].tree)),
    least(), $(".to-lights").checked, hot, off);
  function mark() {
    marks.width = marks.clientWidth * devicePixelRatio; marks.height = marks.clientHeight * devicePixelRatio;
    const g = marks.getContext("2d"), s = marks.width / width, side = Math.max(step * s, 7 * devicePixelRatio);
    pixels.forEach(({x, y}, i) => {
      for (const [style, w] of [["#000", 4], [i === active ? "#fff" : "#bbb", 2]]) {
        Object.assign(g, {strokeStyle: style, lineWidth: w * devicePixelRatio});
        g.strokeRect((x + .5) * s - side / 2, (y + .5) * s - side / 2, side, side);
      }
    });
  }
  function card(p, i) {
    const every = Math.ceil(p.depths / 64), shown = Math.min(depth, p.depths);  // depths to a column
    const depths = Array.from({length: Math.ceil(p.depths / every)}, (_, i) => Math.min(p.depths, (i + 1) * every));
    const series = depths.map(d => weigh(p.tree, data, d, off));
    const {brings, missing} = weigh(p.tree, data, depth, off), sum = total(brings), whole = sum + total(missing) || 1;
    const tallest = Math.max(...series.map(s => total(s.brings) + total(s.missing))) || 1, high = c => `height:${(100 * total(c) / tallest).toFixed(1)}%`;
    const columns = series.map((s, i) => `<div data-depth="${depths[i]}" title="depth ${depths[i]}: ${numbers(s.brings)}, ${numbers(s.missing)} at most missing"${
      i + 1 === Math.ceil(shown / every) ? ' class="now"' : ""}><i class="missing" style="${high(s.missing)}"></i><i style="${high(s.brings)};background:${css(s.brings)}"></i></div>`);
    const part = r => total(r.brings) / (sum || 1), seen = r => r.brings.map((x, c) => x / (r.weight[c] || 1)), large = r => r === p.tree[0] || Math.max(total(r.brings), total(r.missing)) >= least() * whole;
    const list = p.tree.map((r, n) => [r, n]).filter(([r]) => r.level <= depth), told = list.filter(([r]) => large(r)).slice(0, 500);
    const lines = told.sort((a, b) => order(a[0], b[0], p.tree)).map(([r, n]) => `<li class="${KINDS[r.kind]}${r.unfollowed ? " unfollowed" : ""}" data-ray="${n}" style="--level:${Math.min(r.level, 14)}">
      <span><i class="key${r.unfollowed ? " dashed" : ""}"></i>${r.kind ? KINDS[r.kind] + " ray " : "the ray from the camera "}${words(r, data, off)}</span>
      <span class="share" style="--of:${(100 * Math.min(1, part(r))).toFixed(1)}%" title="brings ${numbers(r.brings)}, weighs ${numbers(r.weight)}">${
        r.unfollowed ? `≤ ${(100 * total(r.missing) / whole).toFixed(1)} %` : `${swatch(seen(r))} ${(100 * part(r)).toFixed(1)} %`}</span></li>`);
    const rest = list.length - told.length;
    if (rest) lines.push(`<li class="rest" style="--level:0"><span>and ${rest} ray${rest > 1 ? "s" : ""} that bring${rest > 1 ? "" : "s"} less</span></li>`);
    return `<article class="${i === active ? "active" : ""}" data-pixel="${i}"><div class="head"><canvas class="glass" width="13" height="13" aria-hidden="true"></canvas>
      <h2>Pixel ${p.x}, ${p.y} ${swatch(brings)}</h2><div><p class="sum">radiance <b>${numbers(brings)}</b> from ${list.length} rays; at most <b>${numbers(missing)}</b> is missing</p>
      <div class="bound" role="img" aria-label="of what it may be, ${percent(sum / whole)} is found" title="found, and at most missing"><i style="width:${(100 * sum / whole).toFixed(2)}%"></i>
      <span class="missing" style="width:${(100 - 100 * sum / whole).toFixed(2)}%"></span></div></div></div>
      <div class="depths">${columns.join("")}</div><div class="scale"><span>depth 1 to ${p.depths}: the pixel, and above it what is missing at most</span></div><ol>${lines.join("")}</ol></article>`;
  }
  /** Children stand below their parents, in their order. */
  function order(a, b, tree) {
    const up = (r, level) => { while (r.level > level) r = r.above; return r; };
    const level = Math.min(a.level, b.level), x = up(a, level), y = up(b, level);
    if (x === y) return a.level - b.level;
    let [m, n] = [x, y];
    while (m.above !== n.above) [m, n] = [m.above, n.above];
    return tree.indexOf(m) - tree.indexOf(n);
  }
  function show() {
    const range = $(".depth"), most = Math.max(...pixels.map(p => p.depths));
    Object.assign(range, {max: most, value: Math.min(depth, most)});
    range.nextElementSibling.textContent = `${range.value} of ${data.depth}`;
    const scrolled = [...root.querySelectorAll("ol")].map(list => list.scrollTop);
    $(".pixels").innerHTML = pixels.map(card).join("");
    $(".pixels").classList.toggle("two", pixels.length > 1);
    root.querySelectorAll("ol").forEach((list, i) => list.scrollTop = scrolled[i] || 0);
    root.querySelectorAll(".glass").forEach((glass, i) => {
      const g = glass.getContext("2d"), {x, y} = pixels[i];
      g.imageSmoothingEnabled = false;
      g.drawImage(picture, x - 6, y - 6, 13, 13, 0, 0, 13, 13);
      Object.assign(g, {fillStyle: "#fff", globalAlpha: .75});
      [[5, 5, 3, 1], [5, 7, 3, 1], [5, 6, 1, 1], [7, 6, 1, 1]].forEach(side => g.fillRect(...side));
    });
    hot = undefined;
    marks.setAttribute("aria-label", `the picture: pixel ${pixels[active].x}, ${pixels[active].y} is chosen; click another, or walk with the arrow keys`);
    mark(); draw();
  }
  let asked = 0;
  async function choose(places, which = 0) {
    const ticket = ++asked, snapped = places.map(([x, y]) => [[x, width], [y, height]].map(([v, end]) => {
      const cell = Math.min(Math.floor(Math.max(0, Math.min(end - 1, v)) / step), Math.ceil(end / step) - 1);
      return Math.min(cell * step + (step >> 1), end - 1);
    }));
    try {
      const found = await Promise.all(snapped.map(async ([x, y]) => {
        const known = pixels.find(p => p.x === x && p.y === y);
        if (known) return known;
        const tree = rays(await ask(x, y), data.span);
        return {x, y, tree, depths: Math.max(1, ...tree.map(r => r.level + (r.end < PRUNED)))};
      }));
      if (ticket !== asked) return;
      pixels = found; active = which;
      if (linked) history.replaceState(null, "", "#" + snapped.map(p => p.join()).join(";"));
      show();
    } catch (error) {
      if (ticket === asked) $(".pixels").innerHTML = `<article><p class="failed">${escaped(error.message || error)}</p></article>`;
    }
  }
  const move = (x, y) => choose(pixels.map((p, i) => i === active ? [x, y] : [p.x, p.y]), active);

  marks.addEventListener("pointerdown", e => {
    const box = marks.getBoundingClientRect();
    move(Math.floor((e.clientX - box.left) * width / box.width), Math.floor((e.clientY - box.top) * height / box.height));
  });
  const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
  marks.addEventListener("keydown", e => {
    const way = arrows[e.key];
    if (!way || !pixels.length) return;
    e.preventDefault();
    const by = step * (e.shiftKey ? 10 : 1);
    move(pixels[active].x + by * way[0], pixels[active].y + by * way[1]);
  });
  $(".depth").addEventListener("input", e => { depth = +e.target.value >= +e.target.max ? data.depth : +e.target.value; show(); });
  $(".lights").addEventListener("change", e => { off[e.target.checked ? "delete" : "add"](e.target.value); show(); });
  $(".least").addEventListener("change", show);
  $(".to-lights").addEventListener("change", draw);
  $(".compare").addEventListener("click", e => {
    const two = pixels.length < 2, p = pixels[active];
    e.target.setAttribute("aria-pressed", two);
    e.target.textContent = two ? "one pixel" : "a second pixel";
    if (two) choose([[p.x, p.y], [p.x + (p.x > width / 2 ? -1 : 1) * Math.max(step, width >> 3), p.y]], 1); else choose([[p.x, p.y]]);
  });
  $(".pixels").addEventListener("click", e => {
    const column = e.target.closest("[data-depth]"), at = +e.target.closest("article")?.dataset.pixel;
    if (column) depth = +column.dataset.depth >= pixels[at].depths ? data.depth : +column.dataset.depth;
    if (at >= 0 && (column || at !== active)) { active = at; show(); }
  });
  $(".pixels").addEventListener("pointerover", e => {
    const line = e.target.closest("li[data-ray]"), at = line && +line.closest("article").dataset.pixel;
    root.querySelectorAll("li.on").forEach(other => other.classList.remove("on"));
    line?.classList.add("on");
    hot = line && at === active ? pixels[at].tree[line.dataset.ray] : undefined;
    draw();
  });
  $(".pixels").addEventListener("pointerleave", () => { hot = undefined; draw(); });

  const canvas = $(".space"), center = () => pixels[active].tree[0].finish, up = data.axes[1];
  const turn = (across, down) => { space.turn(up, -across, center()); space.turn(space.axes[0], -down, center()); draw(); };
  let from;
  canvas.addEventListener("pointerdown", e => { from = [e.clientX, e.clientY]; canvas.setPointerCapture(e.pointerId); });
  canvas.addEventListener("pointermove", e => { if (from) { turn((e.clientX - from[0]) / 200, (e.clientY - from[1]) / 200); from = [e.clientX, e.clientY]; } });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => from = undefined);
  canvas.addEventListener("wheel", e => { if (root.getRootNode().activeElement !== canvas) return; e.preventDefault(); space.zoom *= Math.exp(-e.deltaY / 800); draw(); }, {passive: false});
  canvas.addEventListener("keydown", e => {
    const way = arrows[e.key];
    if (way) turn(way[0] / 10, way[1] / 10);
    else if ("+=-".includes(e.key)) space.zoom *= e.key === "-" ? .9 : 1.1;
    else if (e.key === "0") space.home();
    else return;
    e.preventDefault(); draw();
  });
  $(".home").addEventListener("click", () => { space.home(); draw(); });

  const resized = new ResizeObserver(() => { mark(); draw(); }), dark = matchMedia("(prefers-color-scheme: dark)");
  resized.observe(marks);
  dark.addEventListener("change", draw);
  const wanted = () => linked ? [...location.hash.matchAll(/(\d+),(\d+)/g)].slice(0, 2).map(m => [+m[1], +m[2]]) : [];
  const begin = () => choose(wanted().length ? wanted() : [[width >> 1, height >> 1]]);
  if (linked) addEventListener("hashchange", begin);
  picture.decode().then(begin, begin);
  return () => { resized.disconnect(); dark.removeEventListener("change", draw); };
}

/** The rays of a page's pixels: each row of them is JSON, compressed, in base64. */
function unpacked(data) {
  const rows = new Map();
  const unpack = async text => {
    const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).json();
  };
  return async (x, y) => {
    const row = Math.floor(y / data.step);
    if (!rows.has(row)) rows.set(row, unpack(data.rows[row]));
    return (await rows.get(row))[Math.floor(x / data.step)];
  };
}

/** The widget of a notebook, by anywidget: the kernel answers for any pixel. */
export default {
  render({model, el}) {
    const waiting = new Map(), data = JSON.parse(model.get("start"));
    el.classList.add("cistula");
    model.on("msg:custom", ({x, y, rays, error}) => {
      const [done, failed] = waiting.get(`${x},${y}`) || [];
      if (done) rays ? done(JSON.parse(rays)) : failed(error);
    });
    return explore(el, {...data, step: 1}, (x, y) => new Promise((...ends) => { waiting.set(`${x},${y}`, ends); model.send({x, y}); }), false);
  }
};

const page = document.getElementById("cistula-data");
if (page) {
  const data = JSON.parse(page.textContent);
  explore(document.getElementById("cistula"), data, unpacked(data), true);
}
