"""The browser studio: visits with their clock and controls, the page, and the server between them."""
