// Elements of the page. Text goes in as text only: names of scenes and files are never read as HTML.

function append(node, children) {
  for (const child of children.flat(Infinity)) {
    if (child !== null && child !== undefined && child !== false) node.append(child);
  }
  return node;
}

function setAttributes(node, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else node.setAttribute(name, value === true ? '' : value);
  }
  return node;
}

export function element(name, attributes = {}, ...children) {
  return append(setAttributes(document.createElement(name), attributes), children);
}

export function svgElement(name, attributes = {}, ...children) {
  return append(setAttributes(document.createElementNS('http://www.w3.org/2000/svg', name), attributes), children);
}

// A row of buttons of which one is pressed. `choices` are {value, text, label?}; `choose` hears of each choice.
export function choiceRow(label, choices, value, choose) {
  const buttons = choices.map((choice) => element('button', {
    type: 'button', 'data-value': choice.value, 'aria-label': choice.label,
    onclick: () => {
      row.show(choice.value);
      choose(choice.value);
    },
  }, choice.text));
  const row = element('div', {class: 'choices', role: 'group', 'aria-label': label}, buttons);
  row.show = (shown) => {
    for (const [i, button] of buttons.entries()) {
      button.setAttribute('aria-pressed', String(choices[i].value === shown));
    }
  };
  row.show(value);
  return row;
}
