// Starts the panel; says so in plain words when that fails.
import init from './{{panel.js}}';

const note = document.getElementById('boot');
try {
  const theme = localStorage.getItem('theme');
  if (theme === 'light' || theme === 'dark') document.documentElement.dataset.theme = theme;
} catch { /* Without storage the theme follows the system. */ }
init({ module_or_path: './{{panel.wasm}}' }).then(() => note.remove()).catch((error) => {
  note.setAttribute('role', 'alert');
  note.textContent = `The panel could not start in this browser: ${error}. Reload the page, or try a newer browser.`;
});
