// recording.mcap in the reader of Foxglove: every channel with its unit, values to the bit, times to 1 ns, as samples.parquet has them and what `idc import` makes of the file.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { parquetReadObjects } from "hyparquet";
import { McapIndexedReader } from "@mcap/core";
import { loadDecompressHandlers } from "@mcap/support";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { results, run } from "./common.mjs";

// The value of a path such as `wrench.force.x` or `position[2]`.
const at = (message, path) => path.split(/[.[\]]+/).filter(Boolean).reduce((value, step) => value[step], message);

const unitOf = { rad: "rad", rad_per_s: "rad/s", n_m: "N m", n: "N", pa: "Pa", m: "m", m_per_s: "m/s", m_per_s2: "m/s2", kg: "kg", 1: "1", m3_per_s: "m3/s", w: "W", j: "J" };

const read = async (file) => {
  const bytes = readFileSync(file);
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) => bytes.subarray(Number(offset), Number(offset + length)),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers: await loadDecompressHandlers() });
  const readers = new Map();
  const topics = new Map();
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(message.channelId);
    if (!readers.has(channel.id)) {
      const schema = reader.schemasById.get(channel.schemaId);
      const text = new TextDecoder().decode(schema.data);
      readers.set(channel.id, channel.messageEncoding === "json" ? null : new MessageReader(parse(text, { ros2: true })));
      topics.set(channel.topic, { channel, schema, messages: [] });
    }
    const decoder = readers.get(channel.id);
    const value = decoder === null ? JSON.parse(new TextDecoder().decode(message.data)) : decoder.readMessage(message.data);
    topics.get(channel.topic).messages.push({ time: message.logTime, value });
  }
  return { reader, topics };
};

// Columns of a table: no value is NaN.
const table = async (file) => {
  const bytes = readFileSync(file);
  const rows = await parquetReadObjects({ file: bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length) });
  return new Map(Object.keys(rows[0]).map((name) => [name, rows.map((row) => row[name] ?? NaN)]));
};

for (const scenario of ["plate_edge", "deburred_edge", "paper_step"]) {
  test(`${scenario} in Foxglove's reader is the table of its samples`, async () => {
    const folder = join(results, `mcap_${scenario}`);
    run("run", `scenarios/${scenario}.toml`, "--out", folder, "--mcap", "--no-recording", "--force", "--quiet");
    const file = join(folder, "recording.mcap");
    const back = join(folder, "back.parquet");
    run("import", file, "--out", back, "--force", "--quiet");
    const { reader, topics } = await read(file);
    assert.equal(reader.header.profile, "ros2");
    assert.match(reader.header.library, /^idc \d/);
    assert.ok(reader.statistics.messageCount > 0n && reader.chunkIndexes.every((chunk) => chunk.compression === "zstd"));
    for (const columns of [await table(join(folder, "samples.parquet")), await table(back)]) {
      const times = columns.get("time_s").map((time) => BigInt(Math.round(1e9 * time)));
      let found = 0;
      for (const [topic, { channel, messages }] of topics) {
        if (topic === "/phases") continue;
        assert.deepEqual(messages.map((message) => message.time), times, topic);
        for (const { column, field } of JSON.parse(channel.metadata.get("idc_columns"))) {
          const expected = columns.get(column);
          assert.ok(expected, `${column} is a column`);
          assert.ok(messages.every((message, row) => Object.is(at(message.value, field), expected[row])), `${topic}.${field} is ${column}`);
          const endings = Object.keys(unitOf).filter((end) => column.endsWith(`_${end}`));
          const unit = unitOf[endings.sort((a, b) => b.length - a.length)[0]];
          assert.ok(channel.metadata.get("unit").split(", ").includes(unit), `${column}: ${channel.metadata.get("unit")}`);
          found += 1;
        }
      }
      // Beside them time and phase.
      assert.equal(found, columns.size - 2, "every channel once");
      const phases = columns.get("phase");
      const starts = times.filter((_, row) => phases[row] !== phases[row - 1] && typeof phases[row] === "string");
      const messages = topics.get("/phases")?.messages ?? [];
      assert.deepEqual(messages.map((message) => message.time), starts);
      messages.forEach(({ time, value }) => assert.equal(phases[times.indexOf(time)], value.name));
    }
  });
}
