// SPDX-License-Identifier: GPL-3.0-or-later
// The bar at the top of the screen: the player in small, and the menu of the page's contents.
import { element } from "./words.js";

/// The player's controls again, in one line: play or pause, a slider, the place.
export function barPlayer(player, cursor, axes) {
  const play = element("button", { type: "button", class: "bar-play", "aria-label": "Play the move" }, "▶");
  const slider = element("input", {
    type: "range", min: 0, max: 1000, step: 1, value: 0, "aria-label": "Place along the move, from the bar",
  });
  const place = element("span", { class: "place" });
  const show = (position) => {
    slider.value = String(Math.round(player.share * 1000));
    place.textContent = axes[0].says(position);
    slider.setAttribute("aria-valuetext", place.textContent);
  };
  play.addEventListener("click", () => player.toggle());
  slider.addEventListener("input", () => {
    player.stop();
    player.goTo(Number(slider.value) / 1000);
  });
  player.onPlaying = (isPlaying) => {
    play.textContent = isPlaying ? "❚❚" : "▶";
    play.setAttribute("aria-label", isPlaying ? "Pause" : "Play the move");
  };
  cursor.onMove(show);
  show(cursor.position ?? 0);
  return element("div", { class: "bar-player", role: "group", "aria-label": "Playing the move, from the bar" },
    play, player.track(slider), place);
}

/// The menu closes when a section was chosen, by Escape, and by a click elsewhere; without a script it stays open.
export function closeMenuAfterUse(menu) {
  if (!menu) return;
  menu.addEventListener("click", (event) => {
    if (event.target.closest("a")) menu.open = false;
  });
  menu.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !menu.open) return;
    menu.open = false;
    menu.querySelector("summary").focus();
  });
  document.addEventListener("pointerdown", (event) => {
    if (!menu.contains(event.target)) menu.open = false;
  });
}
