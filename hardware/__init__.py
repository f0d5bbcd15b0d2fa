"""Wire formats, drivers, emulators and the serial plant."""
