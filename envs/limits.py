"""What the shipped gripper, its arm and its sensors can do, and the clocks of a control step: every limit once."""

from thermograsp.plant import LATERAL_REACH as LATERAL_REACH
from thermograsp.plant import MAX_HEIGHT as MAX_HEIGHT
from thermograsp.plant import MAX_LATERAL_RATE as MAX_LATERAL_RATE
from thermograsp.plant import MAX_LIFT_RATE as MAX_LIFT_RATE
from thermograsp.plant import MAX_OPENING as MAX_OPENING

TIPS = ("left", "right")
PAD_SIDE = 0.020  # m, the square pad that takes the force
CLEARANCE = 0.002  # m, least gap between pads (or fingers) and what they must not touch
REACH = 0.095  # m, from the grasp centre up to the palm
SUBSTEPS = 10
MAX_FORCE = 40.0  # N
OPENING_SPEED = 0.1  # m/s, the fastest the pads move relative to each other (a Robotiq 2F-85: .02 to .15)
LIFT_ACCELERATION = 1.0  # m/s2, how fast the commanded lift rate is followed
SAMPLE_PERIOD = 0.01  # s, of the converter's clock, and the heat's
HISTORY = 16  # voltage samples kept
MOST_FORCE = 200.0  # N, range of a fingertip's load cell
MOST_RATE = 1.0  # m/s
MOST_VOLTAGE = 0.256  # V, the widest range of the converters we know
THERMOSTAT = (-20.0, 100.0)  # °C
