// Before anything is drawn: the palette that was chosen last, so that no bright frame shows at night.
try {
  const asked = new URLSearchParams(location.search).get('palette');
  const kept = JSON.parse(localStorage.getItem('marine_tracker ppi') ?? '{}').palette;
  const palette = [asked, kept].find((name) => ['day', 'dusk', 'night'].includes(name));
  if (palette) document.documentElement.dataset.obcTheme = palette;
} catch {
  // Nothing kept: the default stands in the page.
}
