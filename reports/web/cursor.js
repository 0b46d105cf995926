// SPDX-License-Identifier: GPL-3.0-or-later
// The cursor: one position along the path, which all plots and the picture of the robot show.

export class Cursor {
  #listeners = [];
  #position;

  /// `last`: the greatest position.
  constructor(last) {
    this.last = last;
  }

  /// Undefined until the reader points at a place.
  get position() {
    return this.#position;
  }

  set position(value) {
    this.#position = Math.min(Math.max(value, 0), this.last);
    for (const listener of this.#listeners) listener(this.#position);
  }

  onMove(listener) {
    this.#listeners.push(listener);
  }
}
