"""Hardware and simulation together: devices that a simulation moves, and a real grasp beside a simulated one."""
