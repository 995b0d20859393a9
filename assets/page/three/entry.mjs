// What the pages use of three.js; build.mjs bundles it.
export {
  BufferAttribute, BufferGeometry, Color, ConeGeometry, DirectionalLight, FrontSide, Group, HemisphereLight, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, MOUSE,
  OrthographicCamera, Quaternion, Scene, SphereGeometry, TOUCH, Vector3, WebGLRenderer, WebGLRenderTarget,
} from "three";
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
export { LineMaterial } from "three/addons/lines/LineMaterial.js";
export { LineSegments2 } from "three/addons/lines/LineSegments2.js";
export { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
export { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";
