"""MuJoCo scenes, the simulated plant, tasks and the Gymnasium environments."""
