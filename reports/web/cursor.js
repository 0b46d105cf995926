// SPDX-License-Identifier: GPL-3.0-or-later
// The place that all pictures show: one position along the path, shared by the plots and the robot.

export class Cursor {
  #listeners = [];
  #position;

  /// `last`: the greatest position.
  constructor(last) {
    this.last = last;
  }

  /// Undefined until someone has pointed anywhere.
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
