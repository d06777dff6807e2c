#!/usr/bin/env node
// Lets a robot do something: node robot.mjs SOCKET [start|follow|drive|room [NUMBER]|rate]
import { createConnection } from 'node:net';
import { setTimeout as sleep } from 'node:timers/promises';

const SEPARATOR = '\x1f';
const [socket, job = 'start', argument] = process.argv.slice(2);
const stream = createConnection(socket);
stream.setEncoding('utf8');

const say = (request) => stream.write(JSON.stringify(request) + SEPARATOR);

async function* updates() {
    let received = '';
    for await (const part of stream) {
        received += part;
        const messages = received.split(SEPARATOR);
        received = messages.pop();
        yield* messages.map((message) => JSON.parse(message));
    }
}

const heard = updates();

async function waitFor(fits) {
    for (;;) {
        const { value: update, done } = await heard.next();
        if (done) {
            throw new Error('the daemon has closed the connection');
        }
        if (update.e === 'failed') {
            throw new Error(`refused (${update.reason}): ${update.text}`);
        }
        if (fits(update)) {
            return update;
        }
    }
}

const answered = (id) => waitFor((update) => update.e === 'done' && update.id === id);

const works = (update) => update.e === 'status' && ['starting', 'cleaning'].includes(update.state);
const place = (pose) => `place: ${pose.x.toFixed(2)} m, ${pose.y.toFixed(2)} m`;

async function stop() {
    say({ c: 'stop', id: 2 });
    await answered(2);
    console.log('stopped');
}

const jobs = {
    // Starts it, follows it until it works, and stops it.
    async start() {
        say({ c: 'watch', topics: ['status', 'pose'] });
        say({ c: 'start', id: 1 });
        await answered(1);
        console.log('state:', (await waitFor(works)).state);
        console.log(place(await waitFor((update) => update.e === 'pose')));
        await stop();
    },

    // Says how old the newest telemetry is, five times.
    async follow() {
        say({ c: 'watch', topics: ['device'] });
        for (let count = 0; count < 5; count += 1) {
            const device = await waitFor((update) => update.e === 'device');
            console.log(`telemetry: ${device.link.age_ms} ms old`);
        }
    },

    // Drives two seconds backwards at 0.1 m/s, as from its dock. The lease of 300 ms is renewed; who lets go stops.
    async drive() {
        say({ c: 'watch', topics: ['pose'] });
        say({ c: 'drive', v: 0, w: 0, ttl: 300, id: 1 });
        await answered(1);
        for (let count = 0; count < 20; count += 1) {
            say({ c: 'drive', v: -0.1, w: 0, ttl: 300 });
            await sleep(100);
        }
        say({ c: 'stop', id: 2 });
        const poses = [];
        await waitFor((update) => {
            if (update.e === 'pose') {
                poses.push(update);
            }
            return update.e === 'done' && update.id === 2;
        });
        console.log('stopped');
        const [begin, end] = [poses.at(0), poses.at(-1)];
        console.log(`driven: ${Math.hypot(end.x - begin.x, end.y - begin.y).toFixed(2)} m`);
    },

    // Cleans the room of this number, or the first one that it knows.
    async room() {
        say({ c: 'watch', topics: ['home', 'status'] });
        const home = await waitFor((update) => update.e === 'home' && update.rooms?.length > 0);
        const room = argument === undefined ? home.rooms[0].id : Number(argument);
        say({ c: 'clean', parts: [{ room }], id: 1 });
        await answered(1);
        console.log('state:', (await waitFor(works)).state);
        console.log('room:', room);
        await stop();
    },

    // Says how many packets a second it understands, until another kind comes.
    async rate() {
        const begin = performance.now();
        let count = 0;
        for await (const update of heard) {
            if (update.e !== 'pose') {
                break;
            }
            count += 1;
        }
        console.log('packets a second:', Math.round((count * 1000) / (performance.now() - begin)));
    },
};

if (job !== 'rate') {
    say({ c: 'hello', name: 'a Node script' });
    const hello = await waitFor((update) => update.e === 'hello');
    console.log('robot:', hello.robot?.device ?? 'none');
}
await jobs[job]();
stream.destroy();
