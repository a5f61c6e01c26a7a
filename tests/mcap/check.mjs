// check.mjs FILE.mcap INFO.json TOPIC=ROWS.jsonl...: every message, count, time and latency of an MCAP file, read by the
// reference reader and decoded by the types in the file, against what `palpate info` and `palpate export` say.
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { parseIDL } from "@foxglove/omgidl-parser";
import { MessageReader } from "@foxglove/omgidl-serialization";
import { open, readFile } from "node:fs/promises";
import assert from "node:assert/strict";

const [file, infoFile, ...rows] = process.argv.slice(2);
const info = JSON.parse(await readFile(infoFile, "utf8"));

const stream = new McapStreamReader({ validateCrcs: true });
stream.append(new Uint8Array(await readFile(file)));
let streamed = 0;
for (let record; (record = stream.nextRecord()); ) streamed += record.type === "Message";
assert.ok(stream.done());

const handle = await open(file);
const readable = {
  size: async () => BigInt((await handle.stat()).size),
  read: async (offset, length) => {
    const buffer = new Uint8Array(Number(length));
    await handle.read(buffer, 0, Number(length), Number(offset));
    return buffer;
  },
};
const reader = await McapIndexedReader.Initialize({ readable });
const readers = new Map();
for (const channel of reader.channelsById.values()) {
  const schema = reader.schemasById.get(channel.schemaId);
  assert.equal(schema.encoding, "omgidl");
  assert.equal(channel.messageEncoding, "cdr");
  const types = parseIDL(new TextDecoder().decode(schema.data));
  readers.set(channel.id, { topic: channel.topic, reader: new MessageReader(schema.name, types), messages: [] });
}
let last = 0n;
for await (const message of reader.readMessages({ validateCrcs: true })) {
  assert.ok(message.logTime >= last);
  last = message.logTime;
  const of = readers.get(message.channelId);
  of.messages.push({ time: message.logTime, published: message.publishTime, value: of.reader.readMessage(message.data) });
}

let count = 0;
for (const { topic, messages } of readers.values()) {
  assert.equal(messages.length, info.topics[topic].samples, topic);
  count += messages.length;
}
assert.equal(readers.size, Object.keys(info.topics).length);
assert.equal(count, streamed);
assert.equal(BigInt(count), reader.statistics.messageCount);

function same(a, b, where) {
  if (typeof a === "bigint" || typeof b === "bigint") assert.equal(String(a), String(b), where);
  else if (typeof a === "number") assert.ok(a === Number(b) || a === Math.fround(Number(b)), `${where}: ${a} and ${b}`);
  else if (ArrayBuffer.isView(a) || Array.isArray(a)) {
    assert.equal(a.length, b.length, where);
    for (let i = 0; i < a.length; ++i) same(a[i], b[i], `${where}[${i}]`);
  } else if (typeof a === "object") for (const key of Object.keys(b)) same(a[key], b[key], `${where}.${key}`);
  else assert.equal(a, b, where);
}
for (const argument of rows) {
  const [topic, path] = argument.split("=");
  const of = [...readers.values()].find((r) => r.topic === topic);
  // Integers beyond 2^53 as text: JSON.parse would round them.
  const lines = (await readFile(path, "utf8")).trim().split("\n");
  assert.equal(lines.length, of.messages.length, topic);
  let offset;
  lines.forEach((line, i) => {
    const row = JSON.parse(line.replace(/([:[,])(-?\d{16,})(?=[,\]}])/g, '$1"$2"'));
    offset ??= of.messages[i].time - BigInt(row.receive_ns);
    assert.equal(of.messages[i].time - BigInt(row.receive_ns), offset, `${topic} time`);
    same(of.messages[i].value, row.message, `${topic}[${i}]`);
  });
}

// Latencies [ns] by the file's own times, moved back to the clock of the recorder's host.
const messagesOf = (topic) => [...readers.values()].find((r) => r.topic === topic)?.messages ?? [];
const told = messagesOf("palpate/force_state")[0];
const since1970 = told.published - told.value.publish_ns;

// Percentiles of `info` are the middles of bins that are a 32nd of their value wide.
function agree(times, said, where) {
  const sorted = times.map((t) => Math.max(Number(t), 0)).sort((a, b) => a - b);
  for (const [name, share] of Object.entries({ p50: 0.5, p90: 0.9, p99: 0.99, p999: 0.999 })) {
    const own = sorted[Math.max(Math.ceil(share * sorted.length), 1) - 1];
    assert.ok(Math.abs(1e3 * said[name] - own) <= own / 32 + 1, `${where} ${name}: ${own} ns and ${said[name]} us`);
  }
  assert.ok(Math.abs(1e3 * said.max - sorted.at(-1)) < 0.5, `${where} max: ${sorted.at(-1)} ns and ${said.max} us`);
  return sorted.at(-1) > 0;
}
// The first surface with each step.
function firstOfEachStep(surfaces) {
  const newest = new Map();
  return surfaces.filter(({ value }) => {
    const step = `${value.run} ${value.step}`;
    const known = newest.has(value.body);
    if (value.run == 0 && known) return false;
    if (newest.get(value.body) === step) return false;
    newest.set(value.body, step);
    return value.run != 0;
  });
}
const toPublish = ({ published, value }) => published - since1970 - value.sense_ns;
let latencies = 0;
for (const { topic, messages } of readers.values()) {
  const sensed = messages.filter(({ value }) => value.sense_ns > 0);
  const figures = info.topics[topic];
  if (figures.sense_to_publish_us) latencies += agree(sensed.map(toPublish), figures.sense_to_publish_us, `${topic} to publish`);
  if (figures.sense_to_receive_us)
    latencies += agree(sensed.map((m) => m.time - since1970 - m.value.sense_ns), figures.sense_to_receive_us, `${topic} to receive`);
}
for (const [hop, messages] of [
  ["tool_to_force", messagesOf("palpate/force_state")],
  ["tool_to_surface", firstOfEachStep(messagesOf("palpate/surface_state"))],
])
  if (info.hops_us[hop]) latencies += agree(messages.map(toPublish), info.hops_us[hop], hop);
console.log(`${count} messages of ${readers.size} topics agree, and ${latencies} latencies that are more than nothing`);
await handle.close();
