// SPDX-License-Identifier: GPL-3.0-or-later
// The page scrolls over the machine as it does elsewhere: only Ctrl and the wheel, or two fingers, are for the picture.

import { TOUCH } from "three";

const HINT_SHOWN = 1800; // [ms]

/// @param stage the element that holds the canvas  @param controls three's OrbitControls of the canvas
/// @param hint an element whose class `shown` makes it visible for a while
export function shareGestures(stage, canvas, controls, hint) {
  let timer;
  const show = (words) => {
    hint.textContent = words;
    hint.classList.add("shown");
    clearTimeout(timer);
    timer = setTimeout(() => hint.classList.remove("shown"), HINT_SHOWN);
  };
  stage.addEventListener("wheel", (event) => {
    if (event.ctrlKey || event.metaKey) return;
    event.stopImmediatePropagation(); // the controls would zoom, and keep the page from scrolling
    show("Hold Ctrl and turn the wheel to zoom");
  }, { capture: true, passive: true });
  controls.touches = { ONE: null, TWO: TOUCH.DOLLY_ROTATE };
  canvas.style.touchAction = "pan-y"; // one finger scrolls the page
  stage.addEventListener("touchstart", (event) => {
    if (event.touches.length > 1 && event.cancelable) event.preventDefault();
  }, { passive: false });
  stage.addEventListener("touchmove", (event) => {
    if (event.touches.length === 1) show("Turn and zoom with two fingers");
    else if (event.cancelable) event.preventDefault();
  }, { passive: false });
}
