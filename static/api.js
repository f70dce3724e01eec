// Requests to the study's own server: one try, or patiently until there is an answer.

const FIRST_WAIT_MS = 500;
const LONGEST_WAIT_MS = 15000;
const PATIENCE_MS = 15000; // for one answer

/** Where a path of the study is on its host, which it may share with others. */
export const at = (path) => (document.body.dataset.root ?? "") + path;

/** The server's no, which trying again cannot change. */
export class Refused extends Error {
  constructor({ status, body }) {
    super(body?.error?.message ?? `The server answered ${status}.`);
    this.status = status;
    this.code = body?.error?.code ?? null;
  }
}

/** One request: {ok, status, body}; GET without `message`, else POST as JSON. Throws when offline. */
export async function request(path, message) {
  const posting = message !== undefined && {
    method: "POST",
    headers: { "content-type": "application/json" },
    body: JSON.stringify(message),
    keepalive: true, // also when the page is left meanwhile
  };
  const response = await fetch(at(path), { ...posting, signal: AbortSignal.timeout(PATIENCE_MS) });
  return { ok: response.ok, status: response.status, body: await response.json().catch(() => null) };
}

/**
 * Try until the server answers: GET without `message()`, which makes what is sent at each try.
 * `retrying(attempt, status)` is told. Throws only Refused.
 */
export async function patiently(path, message, retrying = () => {}) {
  for (let wait = FIRST_WAIT_MS, attempt = 1; ; wait = Math.min(2 * wait, LONGEST_WAIT_MS), attempt += 1) {
    const reply = await request(path, message?.()).catch(() => ({ ok: false, status: 0 }));
    if (reply.ok && reply.body) return reply.body;
    const passing = reply.ok || reply.status === 0 || reply.status >= 500 || [408, 425, 429].includes(reply.status);
    if (!passing) throw new Refused(reply);
    retrying(attempt, reply.status);
    await waitOrOnline(wait);
  }
}

function waitOrOnline(wait) {
  return new Promise((resolve) => {
    const go = () => {
      clearTimeout(timer);
      removeEventListener("online", go);
      resolve();
    };
    const timer = setTimeout(go, wait);
    addEventListener("online", go);
  });
}
