// A home with a controller of Matter: commissions the robot, reads it, follows it and asks it for things.
//
//     node controller.mjs FOLDER < orders > answers
//
// An order is a line of JSON, {"do": NAME, ...}; so is its answer, {"ok": ...} or {"error": TEXT}. FOLDER keeps the home's keys.

import dgram from "node:dgram";
import readline from "node:readline";
import { Environment, Logger } from "@matter/main";
import {
    BasicInformation, Descriptor, PowerSource, RvcCleanMode, RvcOperationalState, RvcRunMode, ServiceArea,
} from "@matter/main/clusters";
import { ManualPairingCodeCodec, NodeId, QrPairingCodeCodec } from "@matter/main/types";
import { CommissioningController } from "@project-chip/matter.js";

const ROBOT = 1;
const LONGEST_WAIT_MS = 30_000;

// Its words would stand among the answers.
console.log = console.info = console.warn = console.error = (...words) => process.stderr.write(`${words.join(" ")}\n`);
Logger.level = process.env.CONTROLLER_LOG ?? "fatal";

const environment = Environment.default;
environment.vars.set("storage.path", process.argv[2]);
const controller = new CommissioningController({
    environment: { environment, id: "home" },
    autoConnect: false,
    adminFabricLabel: "trial",
});
await controller.start();

let node;
const changes = [];
const events = [];

// What crosses a line of JSON.
const plain = value =>
    JSON.parse(JSON.stringify(value ?? null, (_, part) => (typeof part === "bigint" ? Number(part) : part)));

function settings(code, passcode) {
    const parsed = code.startsWith("MT:") ? QrPairingCodeCodec.decode(code)[0] : ManualPairingCodeCodec.decode(code);
    const { discriminator, shortDiscriminator } = parsed;
    return {
        commissioning: { regulatoryCountryCode: "XX" },
        discovery: {
            identifierData: discriminator === undefined ? { shortDiscriminator } : { longDiscriminator: discriminator },
            discoveryCapabilities: { onIpNetwork: true },
        },
        passcode: passcode ?? parsed.passcode,
    };
}

function within(what, promise, wait_ms = LONGEST_WAIT_MS) {
    const late = new Promise((_, refuse) =>
        setTimeout(() => refuse(new Error(`${what}: not within ${wait_ms} ms`)), wait_ms).unref());
    return Promise.race([promise, late]);
}

async function connect() {
    const [id] = controller.getCommissionedNodes();
    node = await controller.getNode(NodeId(id));
    node.events.attributeChanged.on(({ path, value }) => {
        changes.push({ cluster: Number(path.clusterId), attribute: path.attributeName, value: plain(value) });
    });
    node.events.eventTriggered.on(({ path, events: told }) => {
        events.push(...told.map(({ data }) => ({ name: path.eventName, data: plain(data) })));
    });
    const ready = node.initialized ? Promise.resolve() : node.events.initialized;
    if (!node.isConnected) node.connect();
    await within("the first report", ready);
}

const cluster = kind => node.getDeviceById(ROBOT).getClusterClient(kind);

// Straight from the robot, not from what was told before. One after the other: a small device answers few questions at once.
async function read(client, ...names) {
    const values = {};
    for (const name of names) values[name] = plain(await client.attributes[name].get(true));
    return values;
}

const orders = {
    async commission({ code, passcode, wait_ms }) {
        const commissioned = controller.commissionNode(settings(code, passcode), { connectNodeAfterCommissioning: false });
        await within("commissioning", commissioned, wait_ms);
        await connect();
        return true;
    },
    connect,
    async about() {
        const root = node.getRootEndpoint().getClusterClient(BasicInformation);
        const about = await read(root, "vendorId", "productName", "serialNumber");
        const { deviceTypeList } = await read(cluster(Descriptor), "deviceTypeList");
        return { ...about, types: deviceTypeList.map(({ deviceType }) => deviceType) };
    },
    async read() {
        return {
            run: await read(cluster(RvcRunMode), "supportedModes", "currentMode"),
            clean: await read(cluster(RvcCleanMode), "supportedModes", "currentMode"),
            operation: await read(cluster(RvcOperationalState), "operationalStateList", "operationalState", "operationalError"),
            areas: await read(
                cluster(ServiceArea), "supportedAreas", "supportedMaps", "selectedAreas", "currentArea", "acceptedCommandList"),
            power: await read(
                cluster(PowerSource), "status", "batPercentRemaining", "batChargeLevel", "batChargeState", "batPresent"),
        };
    },
    run: ({ mode }) => cluster(RvcRunMode).commands.changeToMode({ newMode: mode }),
    clean: ({ mode }) => cluster(RvcCleanMode).commands.changeToMode({ newMode: mode }),
    select: ({ areas }) => cluster(ServiceArea).commands.selectAreas({ newAreas: areas }),
    pause: () => cluster(RvcOperationalState).commands.pause(),
    resume: () => cluster(RvcOperationalState).commands.resume(),
    home: () => cluster(RvcOperationalState).commands.goHome(),
    // What was told without being asked for, and is forgotten here with the answer.
    told: () => ({ changes: changes.splice(0), events: events.splice(0) }),
    async garbage({ port, count, host }) {
        const socket = dgram.createSocket("udp6");
        let seed = 1;
        const random = () => (seed = (seed * 48271) % 2147483647);
        for (let sent = 0; sent < count; sent += 1) {
            const bytes = Buffer.from(Array.from({ length: 1 + (random() % 1200) }, () => random() % 256));
            // Half of them begin as a message of no session does.
            if (sent % 2 === 0) bytes.fill(0, 0, Math.min(8, bytes.length));
            await new Promise((done, refuse) => socket.send(bytes, port, host, error => (error ? refuse(error) : done())));
        }
        socket.close();
        return count;
    },
};

for await (const line of readline.createInterface({ input: process.stdin })) {
    let answer;
    try {
        const order = JSON.parse(line);
        answer = { ok: plain(await orders[order.do](order)) };
    } catch (error) {
        answer = { error: String(error?.message ?? error) };
    }
    process.stdout.write(`${JSON.stringify(answer)}\n`);
}
await controller.close();
process.exit(0);
