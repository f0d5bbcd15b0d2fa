"""What setup.cfg requires at the least, a pinned requirement a line."""

import configparser
from pathlib import Path

setup = configparser.ConfigParser()
setup.read(Path(__file__).parents[1] / "setup.cfg")
for requirement in setup["options"]["install_requires"].split("\n"):
    if ">=" in requirement:
        print(requirement.replace(" ", "").replace(">=", "=="))
