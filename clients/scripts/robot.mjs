#!/usr/bin/env node
// Starts the robot, follows it until it works, and stops it: node robot.mjs SOCKET
import { createConnection } from 'node:net';

const SEPARATOR = '\x1f';
const stream = createConnection(process.argv[2]);
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

say({ c: 'hello', name: 'a Node script' });
const hello = await waitFor((update) => update.e === 'hello');
console.log('robot:', hello.robot?.device ?? 'none');
say({ c: 'watch', topics: ['status', 'pose'] });
say({ c: 'start', id: 1 });
await answered(1);
const status = await waitFor((update) => update.e === 'status' && ['starting', 'cleaning'].includes(update.state));
console.log('state:', status.state);
const pose = await waitFor((update) => update.e === 'pose');
console.log(`place: ${pose.x.toFixed(2)} m, ${pose.y.toFixed(2)} m`);
say({ c: 'stop', id: 2 });
await answered(2);
console.log('stopped');
stream.destroy();
