// Keeps the shell of this version, so that the page opens without the robot. Answers of the robot are never kept.
const CACHE = 'shell-{{version}}';
const SHELL = [{{files}}];

addEventListener('install', (event) => {
  // The page keeps its name through all versions: what a cache of the browser has of it may be another one.
  const fresh = SHELL.map((path) => new Request(path, path === '/' ? { cache: 'reload' } : {}));
  event.waitUntil(caches.open(CACHE).then((cache) => cache.addAll(fresh)).then(() => skipWaiting()));
});

addEventListener('activate', (event) => {
  const forget = async () => {
    const names = await caches.keys();
    await Promise.all(names.filter((name) => name !== CACHE).map((name) => caches.delete(name)));
    await clients.claim();
  };
  event.waitUntil(forget());
});

// The page comes from the robot while that answers: with it come the names of the files of one version.
async function page(request) {
  try {
    return await fetch(request);
  } catch (error) {
    const kept = await caches.match('/', { cacheName: CACHE });
    if (kept) return kept;
    throw error;
  }
}

// Names of files carry a hash of their content, so a file that is kept is the right one.
async function file(request) {
  return (await caches.match(request, { cacheName: CACHE })) ?? fetch(request);
}

addEventListener('fetch', (event) => {
  const { request } = event;
  const { origin, pathname } = new URL(request.url);
  if (request.method !== 'GET' || origin !== location.origin) return;
  if (pathname === '/') event.respondWith(page(request));
  else if (SHELL.includes(pathname)) event.respondWith(file(request));
});

// A press on a notice leads to the page.
addEventListener('notificationclick', (event) => {
  event.notification.close();
  const lead = async () => {
    const [open] = await clients.matchAll({ type: 'window', includeUncontrolled: true });
    await (open ? open.focus() : clients.openWindow('/'));
  };
  event.waitUntil(lead());
});
