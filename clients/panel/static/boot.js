// Starts the panel; says so in plain words when that fails.
// The module is asked for here and now, and nowhere else: not every browser takes one that the page has loaded ahead.
const module = fetch('./{{panel.wasm}}');

const texts = {
  en: {
    loading: 'Loading the panel …',
    failed: (error) => `The panel could not start in this browser: ${error}. Reload the page, or try a newer browser.`,
  },
  et: {
    loading: 'Paneel laadib …',
    failed: (error) => `Paneel ei käivitunud selles veebilehitsejas: ${error}. Laadi leht uuesti või proovi uuemat veebilehitsejat.`,
  },
};

function kept(name) {
  try { return localStorage.getItem(name); } catch { return null; /* Without storage nothing is chosen. */ }
}

const root = document.documentElement;
const theme = kept('theme');
if (theme === 'light' || theme === 'dark') root.dataset.theme = theme;
// A browser that keeps nothing has the choice in the page's address.
const chosen = new URLSearchParams(location.search).get('language');
const wanted = [chosen, kept('language'), ...navigator.languages].map((tag) => (tag ?? '').split('-')[0].toLowerCase());
root.lang = wanted.find((language) => language in texts) ?? 'en';
const text = texts[root.lang];

const note = document.getElementById('boot');
note.textContent = text.loading;
async function start() {
  const [{ default: init }, answer] = await Promise.all([import('./{{panel.js}}'), module]);
  await init({ module_or_path: answer });
}
start().then(() => note.remove()).catch((error) => {
  note.setAttribute('role', 'alert');
  note.textContent = text.failed(error);
});

// Browsers keep the page only where nobody can have put another one in its place.
if (isSecureContext && 'serviceWorker' in navigator) {
  navigator.serviceWorker.register('/sw.js').catch((error) => console.warn(`the page is not kept: ${error}`));
}
