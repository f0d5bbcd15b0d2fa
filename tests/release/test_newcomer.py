"""docs/start.md, done literally in a fresh clone."""

from pathlib import Path

from ..docs.pages import blocks
from .tree import clean_environment, clone, run

PAGE = "docs/start.md"


def test_five_minutes(tmp_path: Path) -> None:
    folder = clone(tmp_path / "thermograsp")
    home = tmp_path / "home"
    home.mkdir()
    python = "".join(f"python - <<'END'\n{block}END\n" for block in blocks(PAGE, "python"))
    script = "set -e\n" + "".join(blocks(PAGE, "sh")) + python
    said = run(["bash", "-c", script], folder, clean_environment(home))
    assert (folder / "out" / "demo" / "index.html").is_file()
    for file in ("press.svg", "glass.csv"):
        assert (folder / file).stat().st_size > 1000
    assert "glass" in said and "lifted and held" in said and "aluminium" in said
