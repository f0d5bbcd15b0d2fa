"""Add our fingertips to a batch that PyTorch simulates: grippers close on boxes of several materials.

The mechanics here stand in for yours: two fingers a row, pushed by a motor onto a springy face. What the fingertips
need of them is the normal force on each pad, a tensor (rows, 2) in N, on any device. The lines marked (*) are theirs.
"""

import torch  # pyright: ignore[reportMissingImports]

from thermograsp import thermal

MATERIALS = ["cotton", "wood", "glass", "stainless_steel", "aluminium"]
ROWS, SUBSTEPS, SUBSTEP, STEPS = 250, 10, 0.002, 100  # 2 s in all
MASS, STIFFNESS, DAMPING = 0.2, 2e4, 60.0  # kg, N/m, N s/m of a finger


def close(gap: torch.Tensor, speed: torch.Tensor, motor: torch.Tensor):
    """(gap m, speed m/s, forces N of the substeps (rows, 10, 2)) 20 ms later, of fingers pushed by `motor` N."""
    forces = []
    for _ in range(SUBSTEPS):
        forces.append((-STIFFNESS * gap).clip(0.0))
        speed = speed + SUBSTEP / MASS * (forces[-1] - motor - DAMPING * speed)
        gap = gap + SUBSTEP * speed
    return gap, speed, torch.stack(forces, 1)


def main() -> dict[str, float]:
    """Prints the voltages as they rise and returns those after 2 s, V, mean of each material's grippers."""
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    generator = torch.Generator().manual_seed(0)
    gap = (0.005 + 0.02 * torch.rand((ROWS, 2), generator=generator)).to(device)
    motor = (5.0 + 10.0 * torch.rand((ROWS, 1), generator=generator)).expand(ROWS, 2).to(device)
    speed = torch.zeros_like(gap)
    which = torch.arange(ROWS, device=device) % len(MATERIALS)

    tips = thermal.array_fingertips(MATERIALS, dt=SUBSTEPS * SUBSTEP, like=gap)  # (*)
    state = tips.start(ROWS)  # (*)
    print(
        f"{ROWS} grippers on {device}, mean voltage in mV\n   s  force",
        *(f"{name:>16}" for name in MATERIALS),
    )
    volts = dict.fromkeys(MATERIALS, 0.0)
    for step in range(1, STEPS + 1):
        gap, speed, forces = close(gap, speed, motor)
        conductance = tips.conductance(forces, which).mean(1)  # (*) of the substeps
        state, voltage, _ = tips.step(state, conductance, which)  # (*)
        if step % 20 == 0:
            volts = {name: float(voltage[which == k].mean()) for k, name in enumerate(MATERIALS)}
            row = "".join(f"{1e3 * value:17.2f}" for value in volts.values())
            print(f"{step * tips.dt:4.1f} {float(forces.mean()):4.1f} N{row}")
    return volts


if __name__ == "__main__":
    main()
