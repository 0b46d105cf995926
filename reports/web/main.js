// What the report's page runs in the browser.
import * as Plot from "@observablehq/plot";
import { WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
window.x = [Plot.plot, Plot.lineY, Plot.areaY, WebGLRenderer, OrbitControls];
