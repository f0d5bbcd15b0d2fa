"""What `thermograsp bench` measures and draws, one room a benchmark.

Each room's door lends `measured(quick, seed, progress)`, which returns a record, and `draw(record, folder, footnote)`,
which reads nothing else."""

from typing import TYPE_CHECKING

from thermograsp.doors import opened

if TYPE_CHECKING:
    from thermograsp.bench.kinds import Progress, Record
    from thermograsp.bench.measured_on import caption, provenance

__all__ = ["Progress", "Record", "caption", "provenance"]

__getattr__ = opened(__name__)
