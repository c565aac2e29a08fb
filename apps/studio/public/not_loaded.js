// Says that the page's own code did not come or does not run, and why. It stands alone, and what it says is in index.html in
// all languages: the tables of words are part of what did not come.
function tellNotLoaded(cause) {
  const app = document.getElementById('app');
  if (app.childElementCount > 0) return;
  app.append(document.getElementById('not-loaded').content.cloneNode(true));
  app.querySelector('output').textContent = cause;
}
addEventListener('error', ({ target }) => { if (target instanceof HTMLScriptElement) tellNotLoaded(target.src); }, true);
addEventListener('unhandledrejection', ({ reason }) => tellNotLoaded(String(reason)));
