"""The browser studio: a session is one visitor's simulation with its clock and controls, the page is what the browser
shows of it, the server carries messages between the two."""
