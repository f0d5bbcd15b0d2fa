// Text that is there already is not set again: the browser would lay out and paint for it.

export function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
}
