"""Press the sensor on ten materials, without a robot, and see that the drop follows the effusivity."""

from thermograsp import thermal

TEN = "cotton wood plastic rubber glass ceramic marble stainless_steel iron aluminium".split()


def main() -> dict[str, float]:
    """Prints a table and returns the temperature drop after 2 s, K, by material."""
    drops = {}
    print(f"{'material':16} effusivity  drop after 2 s  model")
    for material in map(thermal.material, TEN):
        press = thermal.press(material, mode="T", conductance=1e4, seconds=2.0)
        drops[material.name] = float(press.temperature_drop[-1])
        print(f"{material.name:16} {material.effusivity:10.0f} {drops[material.name]:12.2f} K  {press.rung}")
    return drops


if __name__ == "__main__":
    main()
