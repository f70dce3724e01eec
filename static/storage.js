// What this browser keeps: JSON under a name, or nothing where the browser refuses to store.

/** What is kept under a name, or null. */
export function read(name) {
  try {
    return JSON.parse(localStorage.getItem(name));
  } catch {
    return null;
  }
}

/** Keep a value under a name; without storage the study goes on from memory. */
export function write(name, value) {
  try {
    localStorage.setItem(name, JSON.stringify(value));
  } catch {
    // Only a reload would lose what is not kept.
  }
}

/** Milliseconds since 1970, running evenly while a page is open: to measure waiting across reloads. */
export function now() {
  return performance.timeOrigin + performance.now();
}

/** Milliseconds as they are sent and kept: to a tenth. */
export function tenths(milliseconds) {
  return Math.round(milliseconds * 10) / 10;
}
