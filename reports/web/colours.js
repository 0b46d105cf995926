// SPDX-License-Identifier: GPL-3.0-or-later
// Colours that depend on the reader's theme.

/// A custom property of the page's style, as three.js reads colours: "#1f5f99".
export function themed(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim() || "#888888";
}

export function onThemeChange(listener) {
  for (const query of ["(prefers-color-scheme: dark)"]) matchMedia(query).addEventListener("change", listener);
}
