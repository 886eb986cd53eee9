// Fills the page from the results that are embedded in it.
import {showConvergence} from './convergence.mjs';
import {element} from './dom.mjs';
import {showHead} from './head.mjs';
import {showPictures} from './picture_section.mjs';
import {showReading} from './reading.mjs';
import {readEmbedded} from './results.mjs';
import {showSpectrum} from './spectrum_plot.mjs';
import {showTables} from './tables.mjs';

function section(id) {
  return document.getElementById(id);
}

// Paper cannot unfold anything.
function unfoldForPrint() {
  const print = matchMedia('print');
  let unfolded = [];
  print.addEventListener('change', () => {
    if (print.matches) {
      unfolded = [...document.querySelectorAll('details:not([open])')];
      for (const details of unfolded) details.open = true;
    } else {
      for (const details of unfolded) details.open = false;
    }
  });
}

function show() {
  let results, pictures;
  try {
    results = readEmbedded('results');
    pictures = readEmbedded('pictures');
  } catch {
    document.getElementById('page').replaceChildren(
      element('p', {class: 'verdict'}, 'This page is a template: lampyr compare fills it with results.'));
    return;
  }
  document.title = `${results.scene} – lampyr compare`;
  showHead(section('head'), results);
  showConvergence(section('convergence'), results);
  showPictures(section('pictures-section'), results, pictures);
  showSpectrum(section('spectrum'), results);
  showTables(section('numbers'), results);
  showReading(section('reading'), results);
  unfoldForPrint();
}

show();
