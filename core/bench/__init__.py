"""What `thermograsp bench` measures: cost against error, where time steps fail, and a peer's published figures."""
