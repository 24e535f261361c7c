// The REST interface: one function per verb. Problems of the service become `Problem` errors in its own words.

import { save } from "../ui/save.js";

const BASE = "/api/v1";
const KEY = "friction-bench-token";

export class Problem extends Error {
  // tokenSent: the request carried a token; with 401 it is the wrong one, not a missing one
  constructor(status, body, tokenSent = false) {
    super(body.detail || body.title || `the service answered ${status}`);
    this.status = status;
    this.tokenMissing = status === 401 && !tokenSent;
    this.errors = body.errors ?? [];
  }
}

export const token = {
  get: () => sessionStorage.getItem(KEY),
  set: (value) => sessionStorage.setItem(KEY, value),
  forget: () => sessionStorage.removeItem(KEY),
};

function headers(extra = {}) {
  return token.get() ? { Authorization: `Bearer ${token.get()}`, ...extra } : extra;
}

// a browser opens few connections to one service: where they are all taken, STOP would wait for a free one
const waiting = new Set();

export function freeTheWay() {
  for (const one of waiting) one.abort(new Problem(0, { detail: "given up to let STOP through; ask again" }));
}

async function request(path, options = {}) {
  const way = new AbortController();
  const signals = [way.signal, options.signal].filter(Boolean);
  if (path !== "/stop") waiting.add(way);
  let response;
  try {
    response = await fetch(BASE + path, { ...options, signal: AbortSignal.any(signals) });
  } catch (error) {
    if (error.name === "AbortError" || error.name === "TimeoutError" || error instanceof Problem) throw error;
    throw new Problem(0, { detail: "the service does not answer; is 'friction-bench serve' still running?" });
  } finally {
    waiting.delete(way);
  }
  if (!response.ok) {
    const body = await response.json().catch(() => ({}));
    if (response.status === 401) document.dispatchEvent(new CustomEvent("token-needed"));
    throw new Problem(response.status, body, Boolean(options.headers?.Authorization));
  }
  return response;
}

// job: a name under which the service tells how far it has come
export async function get(path, query = {}, { timeout_ms = 0, signal, job } = {}) {
  const pairs = Object.entries(query).filter(([, value]) => value !== "" && value !== null && value !== undefined);
  const search = pairs.length ? `?${new URLSearchParams(pairs)}` : "";
  return (await request(path + search, { headers: headers(named(job)), signal: signal ?? timeLimit(timeout_ms) })).json();
}

function named(job) {
  return job ? { "X-Job": job } : {};
}

function timeLimit(timeout_ms) {
  return timeout_ms ? AbortSignal.timeout(timeout_ms) : undefined;
}

export async function post(path, body = {}, timeout_ms = 0, { signal = timeLimit(timeout_ms), job } = {}) {
  const options = { method: "POST", headers: headers({ "Content-Type": "application/json", ...named(job) }), body: JSON.stringify(body), signal };
  return (await request(path, options)).json();
}

export async function patch(path, body) {
  const options = { method: "PATCH", headers: headers({ "Content-Type": "application/json" }), body: JSON.stringify(body) };
  return (await request(path, options)).json();
}

export async function upload(path, file, query = {}) {
  const options = { method: "POST", headers: headers({ "Content-Type": "application/zip" }), body: file };
  return (await request(`${path}?${new URLSearchParams(query)}`, options)).json();
}

export async function remove(path) {
  const response = await request(path, { method: "DELETE", headers: headers() });
  return response.status === 204 ? null : response.json();
}

// the file is fetched with the token and handed over as a blob: the token never stands in an address
export async function download(path, name, { signal, job } = {}) {
  const response = await request(path, { headers: headers(named(job)), signal });
  save(name, await response.blob());
}

// server-sent events over fetch (EventSource cannot send the token); yields {event, data}
export async function* events(path, signal) {
  const response = await request(path, { headers: headers({ Accept: "text/event-stream" }), signal });
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
  let text = "";
  for (;;) {
    const { value, done } = await reader.read();
    if (done) return;
    text += value;
    const blocks = text.split(/\r?\n\r?\n/);
    text = blocks.pop();
    yield* blocks.map(parse).filter(Boolean);
  }
}

function parse(block) {
  let event = "message";
  const data = [];
  for (const line of block.split(/\r?\n/)) {
    if (line.startsWith("event:")) event = line.slice(6).trim();
    if (line.startsWith("data:")) data.push(line.slice(5));
  }
  return data.length ? { event, data: JSON.parse(data.join("\n")) } : null;
}
