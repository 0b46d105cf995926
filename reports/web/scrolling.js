// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes that scroll sideways: those wider than the page say so and can be reached by keys, all others cannot, so that
// nobody has to step through them.
const boxes = ".scroll, .readout-table";
const watched = new WeakSet();

function mark(box) {
  const overflows = box.scrollWidth > box.clientWidth + 1;
  box.classList.toggle("overflows", overflows);
  if (overflows) {
    box.tabIndex = 0;
    box.setAttribute("role", "region");
    if (!box.hasAttribute("aria-label")) {
      box.setAttribute("aria-label", box.querySelector("caption")?.textContent ?? "Table");
    }
  } else {
    for (const attribute of ["tabindex", "role"]) box.removeAttribute(attribute);
  }
}

/// Marks all such boxes of the page, now and whenever their size changes; those that are new since the last call, too.
export function watchScrolling() {
  const observer = new ResizeObserver((entries) => entries.forEach(({ target }) => mark(target.closest(boxes))));
  for (const box of document.querySelectorAll(boxes)) {
    if (watched.has(box)) continue;
    watched.add(box);
    observer.observe(box);
    for (const child of box.children) observer.observe(child);
    mark(box);
  }
}
