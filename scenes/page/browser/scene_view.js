// The meshes of a run in three dimensions. Draws when something has changed, not all the time.

const clothColours = ['#c65d47', '#3f7fae', '#7c9b4e', '#a77fc4', '#d3a046', '#4ba59a'];
const obstacleColour = '#a9aeb7';
const viewDirections = { front: [0.35, 0.25, 1], back: [-0.35, 0.25, -1], side: [1, 0.2, 0.25], top: [0.0, 1, 0.02] };

/** One mesh: its packed numbers, and what is drawn of them. */
class ShownMesh {
  constructor(data, number) {
    this.data = data;
    this.name = data.name;
    this.isCloth = data.cloth;
    this.colour = data.cloth ? clothColours[number % clothColours.length] : obstacleColour;
    this.positions = takeNumbers16(data.positions);
    this.corners = takeNumbers32(data.corners);
    this.fields = new Map(data.fields.map(field => [field.name, { ...field, values: takeNumbers16(field.values) }]));
    this.place = -1;
    const count = 3 * data.vertices;
    this.geometry = new THREE.BufferGeometry();
    for (const name of ['position', 'normal', 'color'])
      this.geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(count), 3));
    this.geometry.setIndex(new THREE.BufferAttribute(data.vertices < 65536 ? new Uint16Array(this.corners) : this.corners, 1));
    this.makeParts();
  }

  makeParts() {
    const solid = side => new THREE.MeshPhongMaterial({
      side, shininess: 12, specular: 0x111111, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    this.front = new THREE.Mesh(this.geometry, solid(this.isCloth ? THREE.FrontSide : THREE.DoubleSide));
    this.back = this.isCloth ? new THREE.Mesh(this.geometry, solid(THREE.BackSide)) : null;
    this.wires = new THREE.Mesh(this.geometry,
      new THREE.MeshBasicMaterial({ wireframe: true, color: 0x10131a, transparent: true, opacity: 0.28, depthWrite: false }));
    this.wires.visible = false;
    this.group = new THREE.Group();
    for (const part of [this.front, this.back, this.wires]) {
      if (!part) continue;
      part.frustumCulled = false;
      this.group.add(part);
    }
    this.front.castShadow = true;
    for (const part of [this.front, this.back]) if (part) part.receiveShadow = true;
    this.paint(null);
  }

  /** Coordinates of a frame of the page, m. */
  coordinates(frame) {
    const { axes, vertices, moves } = this.data, start = moves ? 3 * vertices * frame : 0;
    const to = this.geometry.attributes.position.array;
    for (let v = 0; v < vertices; ++v)
      for (let k = 0; k < 3; ++k) to[3 * v + k] = axes[k].low + axes[k].step * this.positions[start + 3 * v + k];
    return to;
  }

  show(frame) {
    const place = this.data.moves ? frame : 0;
    if (place === this.place) return;
    this.place = place;
    addNormals(this.coordinates(place), this.corners, this.geometry.attributes.normal.array);
    this.geometry.attributes.position.needsUpdate = true;
    this.geometry.attributes.normal.needsUpdate = true;
    this.paint(this.colouring);
  }

  /** Colours by a field: {name, low, high, ramp}, in the unit of the file; null: plain. */
  paint(colouring) {
    this.colouring = colouring;
    const field = colouring && this.fields.get(colouring.name);
    for (const part of [this.front, this.back]) {
      if (!part) continue;
      const material = part.material, wanted = field ? THREE.VertexColors : THREE.NoColors;
      if (material.vertexColors !== wanted) material.needsUpdate = true;
      material.vertexColors = wanted;
      material.color.set(field ? '#dedede' : this.colour);
      if (part === this.back) material.color.multiplyScalar(field ? 0.86 : 0.72);
    }
    if (field && this.place >= 0) this.paintVertices(field, colouring);
  }

  paintVertices(field, { low, high, ramp }) {
    const count = this.data.vertices, start = count * this.place, colours = this.geometry.attributes.color;
    for (let v = 0; v < count; ++v) {
      const number = field.values[start + v];
      if (number === absent) colours.array.fill(0.55, 3 * v, 3 * v + 3);
      else rampColour(ramp, (field.range.low + field.range.step * number - low) / (high - low), colours.array, 3 * v);
    }
    colours.needsUpdate = true;
  }

  /** The values of a field in the frame that is shown, ascending. */
  sortedValues(name) {
    const field = this.fields.get(name), count = this.data.vertices;
    if (!field) return [];
    const numbers = field.values.subarray(count * this.place, count * (this.place + 1)).filter(number => number !== absent);
    return Array.from(numbers.sort(), number => field.range.low + field.range.step * number);
  }

  /** Of all frames. */
  box() {
    const end = axis => axis.low + axis.step * (absent - 1);
    const { axes } = this.data;
    return new THREE.Box3(new THREE.Vector3(...axes.map(axis => axis.low)), new THREE.Vector3(...axes.map(end)));
  }
}

/** Normals of vertices: the sum of those of their triangles by area, of length 1. */
function addNormals(x, corners, normals) {
  normals.fill(0);
  for (let i = 0; i < corners.length; i += 3) {
    const a = 3 * corners[i], b = 3 * corners[i + 1], c = 3 * corners[i + 2];
    const ux = x[b] - x[a], uy = x[b + 1] - x[a + 1], uz = x[b + 2] - x[a + 2];
    const vx = x[c] - x[a], vy = x[c + 1] - x[a + 1], vz = x[c + 2] - x[a + 2];
    const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    for (const place of [a, b, c]) {
      normals[place] += nx;
      normals[place + 1] += ny;
      normals[place + 2] += nz;
    }
  }
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.sqrt(normals[i] ** 2 + normals[i + 1] ** 2 + normals[i + 2] ** 2) || 1;
    for (let k = 0; k < 3; ++k) normals[i + k] /= length;
  }
}

class SceneView {
  /** Throws where the browser has no WebGL. */
  constructor(canvas, stage, meshes) {
    this.canvas = canvas;
    this.stage = stage;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFSoftShadowMap;
    const numbers = { true: 0, false: 0 };
    this.meshes = meshes.map(mesh => new ShownMesh(mesh, numbers[mesh.cloth]++));
    this.scene = new THREE.Scene();
    for (const mesh of this.meshes) this.scene.add(mesh.group);
    this.findFocus();
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.01, 100);
    this.addLights();
    this.addGround();
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableKeys = false;
    this.controls.enableZoom = false;  // until the picture is clicked: before that the wheel moves the page
    canvas.addEventListener('focus', () => { this.controls.enableZoom = true; });
    canvas.addEventListener('blur', () => { this.controls.enableZoom = false; });
    canvas.addEventListener('pointerdown', event => {
      canvas.focus({ preventScroll: true });
      if (event.pointerType === 'touch') this.controls.enableZoom = true;
    });
    this.controls.addEventListener('change', () => this.draw());
    this.look('front');
    new ResizeObserver(() => this.resize()).observe(stage);
    this.resize();
  }

  /** What is looked at: the cloth in all frames, and obstacles that are not much larger. */
  findFocus() {
    const size = box => box.getSize(new THREE.Vector3()).length();
    this.focus = new THREE.Box3();
    for (const mesh of this.meshes) if (mesh.isCloth) this.focus.union(mesh.box());
    const cloth = size(this.focus);
    this.whole = this.focus.clone();
    for (const mesh of this.meshes) {
      if (mesh.isCloth) continue;
      this.whole.union(mesh.box());
      if (size(mesh.box()) < 3.5 * cloth) this.focus.union(mesh.box());
    }
    this.centre = this.focus.getCenter(new THREE.Vector3());
    this.radius = Math.max(1e-6, 0.5 * size(this.focus));
  }

  addLights() {
    const reach = this.radius;
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x9a98a4, 0.58));
    this.sun = new THREE.DirectionalLight(0xffffff, 0.46);
    this.sun.position.copy(this.centre).add(new THREE.Vector3(-0.9, 2.2, 1.5).multiplyScalar(reach));
    this.sun.target.position.copy(this.centre);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -0.0025;
    this.sun.shadow.radius = 3;
    Object.assign(this.sun.shadow.camera,
      { left: -1.3 * reach, right: 1.3 * reach, top: 1.3 * reach, bottom: -1.3 * reach, near: 0.5 * reach, far: 5.5 * reach });
    // A weak light from where the camera is: what faces the viewer is never dark.
    const beside = new THREE.DirectionalLight(0xffffff, 0.24);
    this.camera.add(beside, beside.target);
    beside.position.set(0, 0, 0);
    beside.target.position.set(0, 0, -1);
    this.scene.add(this.sun, this.sun.target, this.camera);
  }

  addGround() {
    const reach = this.radius, height = this.focus.min.y - 0.004 * reach;
    this.ground = new THREE.Mesh(new THREE.PlaneGeometry(12 * reach, 12 * reach), new THREE.ShadowMaterial({ opacity: 0.16 }));
    this.ground.rotation.x = -0.5 * Math.PI;
    this.ground.position.set(this.centre.x, height, this.centre.z);
    this.ground.receiveShadow = true;
    const [first, second] = niceTicks(0, 2 * reach, 8);
    this.gridStep = second - first;
    const lines = 2 * Math.ceil(1.6 * reach / this.gridStep);
    this.grid = new THREE.GridHelper(lines * this.gridStep, lines, 0x8088a0, 0x8088a0);
    this.grid.material.transparent = true;
    this.grid.material.opacity = 0.28;
    this.grid.position.copy(this.ground.position);
    const snapped = axis => Math.round(this.centre[axis] / this.gridStep) * this.gridStep;
    this.grid.position.x = snapped('x');
    this.grid.position.z = snapped('z');
    this.scene.add(this.ground, this.grid);
  }

  look(name) {
    const direction = new THREE.Vector3(...viewDirections[name]).normalize();
    const half = 0.5 * this.camera.fov * Math.PI / 180;
    const narrow = Math.atan(Math.tan(half) * Math.min(1, this.camera.aspect));
    const distance = 0.94 * this.radius / Math.sin(narrow);
    this.camera.position.copy(this.centre).addScaledVector(direction, distance);
    const far = this.whole.getSize(new THREE.Vector3()).length() + 8 * this.radius;
    this.camera.near = this.radius / 200;
    this.camera.far = distance + far;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(this.centre);
    this.controls.maxDistance = 10 * distance;
    this.controls.update();
    this.facing = name;
  }

  /** Turns the camera about the cloth, rad, and moves it nearer by a factor. */
  turn(across, up, nearer) {
    const arm = this.camera.position.clone().sub(this.controls.target);
    const place = new THREE.Spherical().setFromVector3(arm);
    place.theta += across;
    place.phi = Math.max(0.02, Math.min(Math.PI - 0.02, place.phi + up));
    place.radius *= nearer;
    this.camera.position.setFromSpherical(place).add(this.controls.target);
    this.controls.update();
  }

  resize() {
    const width = this.stage.clientWidth, height = this.stage.clientHeight;
    if (width === 0 || height === 0) return;
    const before = this.camera.aspect;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (this.facing && Math.min(1, before) !== Math.min(1, this.camera.aspect)) this.look(this.facing);
    this.draw();
  }

  show(frame) {
    for (const mesh of this.meshes) mesh.show(frame);
    this.draw();
  }

  paint(colouring) {
    for (const mesh of this.meshes) mesh.paint(colouring);
    this.draw();
  }

  setWires(on) {
    for (const mesh of this.meshes) mesh.wires.visible = on;
    this.draw();
  }

  setShadows(on) {
    this.sun.castShadow = on;
    this.ground.visible = on;
    this.draw();
  }

  setGrid(on) {
    this.grid.visible = on;
    this.draw();
  }

  setVisible(mesh, on) {
    mesh.group.visible = on;
    this.draw();
  }

  /** In the next frame of the screen, once. */
  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.drawNow();
    });
  }

  drawNow() { this.renderer.render(this.scene, this.camera); }

  /** For tests: how many pixels are covered, and a sum over all that changes with what is drawn. */
  pixelSum() {
    this.drawNow();
    const gl = this.renderer.getContext(), width = gl.drawingBufferWidth, height = gl.drawingBufferHeight;
    const pixels = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let sum = 0, drawn = 0;
    for (let i = 0; i < pixels.length; i += 4) {
      if (pixels[i + 3] === 255) ++drawn;
      sum = (31 * sum + pixels[i] + 3 * pixels[i + 1] + 7 * pixels[i + 2]) % 4294967291;
    }
    return { sum, drawn };
  }
}
