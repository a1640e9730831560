// Load descriptions with three.js' urdf-loader: `node load.mjs FOLDER_OF_NODE_MODULES`.
// Standard input has one description a line; standard output gets one line of JSON for each.
// The loader supports STL and COLLADA; OBJ and glTF are added as its documentation describes.
import fs from 'node:fs';
import path from 'node:path';
import readline from 'node:readline';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';

const folder = path.resolve(process.argv[2]);
const require = createRequire(path.join(folder, 'index.js'));
const load = (name) => import(pathToFileURL(path.join(folder, 'node_modules', name)).href);
const { JSDOM } = require('jsdom');
const dom = new JSDOM('');
for (const name of ['DOMParser', 'document', 'Node', 'Element', 'Document', 'XMLSerializer']) {
  globalThis[name] = dom.window[name];
}
globalThis.window = dom.window;
globalThis.self = globalThis;
for (const name of ['log', 'warn', 'error', 'info']) console[name] = () => {};

const { default: URDFLoader } = await load('urdf-loader/src/URDFLoader.js');
const THREE = await load('three/build/three.module.js');
const addons = 'three/examples/jsm/loaders';
const { STLLoader } = await load(`${addons}/STLLoader.js`);
const { ColladaLoader } = await load(`${addons}/ColladaLoader.js`);
const { OBJLoader } = await load(`${addons}/OBJLoader.js`);
const { GLTFLoader } = await load(`${addons}/GLTFLoader.js`);

function bytes(file) {
  const data = fs.readFileSync(file);
  return data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength);
}

async function readMesh(file) {
  const suffix = path.extname(file).toLowerCase();
  if (suffix === '.stl') return new THREE.Mesh(new STLLoader().parse(bytes(file)));
  if (suffix === '.dae') {
    const found = new ColladaLoader().parse(fs.readFileSync(file, 'utf8'), path.dirname(file));
    if (!found) throw new Error('no scene');
    return found.scene;
  }
  if (suffix === '.obj') return new OBJLoader().parse(fs.readFileSync(file, 'utf8'));
  if (suffix === '.glb' || suffix === '.gltf') {
    const found = await new GLTFLoader().parseAsync(bytes(file), path.dirname(file) + '/');
    return found.scene;
  }
  throw new Error(`no loader of ${suffix} files`);
}

async function run(file) {
  const loader = new URDFLoader();
  loader.workingPath = path.dirname(file) + '/';
  loader.parseCollision = true;
  const pending = [];
  loader.loadMeshCb = (name, manager, material, done) => {
    const where = decodeURI(name.replace(/^file:\/\//, ''));
    pending.push(readMesh(where).then((mesh) => {
      done(mesh);
      return mesh;
    }));
  };
  const robot = loader.parse(fs.readFileSync(file, 'utf8'));
  const meshes = await Promise.all(pending);
  for (const mesh of meshes) {
    let triangles = 0;
    mesh.traverse((part) => { if (part.isMesh) triangles += 1; });
    if (!triangles) throw new Error('a mesh is empty');
  }
  return { links: Object.keys(robot.links).length };
}

for await (const line of readline.createInterface({ input: process.stdin })) {
  let answer;
  try {
    answer = { ok: true, ...(await run(line)) };
  } catch (error) {
    answer = { ok: false, why: String(error.message || error).slice(0, 300) };
  }
  process.stdout.write(JSON.stringify({ path: line, ...answer }) + '\n');
}
