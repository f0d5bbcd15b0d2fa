import numpy as np
import pytest
from scipy.special import erfc, erfcinv

from thermograsp.errors import InvalidValueError
from thermograsp.thermal.contact.rough_faces import (
    AIR,
    LAPPED_ALUMINA,
    Joint,
    Surface,
    contact_conductance,
    gas_conductance,
    joint,
    solid_conductance,
    stack_joints,
    typical_slope,
)
from thermograsp.thermal.matter.materials import Material


def metal(conductivity: float, modulus: float, hardness: float, roughness: float) -> Surface:
    return Surface(conductivity, roughness, typical_slope(roughness), modulus, 0.3, hardness)


STEEL = metal(16.2, 193e9, 3e9, 1e-6)
RUBBER = Surface(0.16, 5e-6, 0.15, 3e6, 0.49)
PRESSURES = np.geomspace(1e2, 1e6, 41)


def simple(**changes: float) -> Joint:
    values = dict(
        conductivity=1.0, roughness=1e-6, slope=1.0, hardness=1.0, elastic_hardness=1.0, elastic_share=0.0
    )
    return Joint(**{**values, "gas_conductivity": 0.0, "jump": 0.0, **changes})


LAMBDA = np.linspace(2, 4.75, 56)


def test_plastic_correlation_fits_the_theory_it_was_made_from() -> None:
    """Yovanovich 1982: the power law is within 1.5 % of the theory for 2 <= Y/sigma <= 4.75."""
    pressure = erfc(LAMBDA / np.sqrt(2)) / 2
    theory = np.exp(-(LAMBDA**2) / 2) / (2 * np.sqrt(2 * np.pi)) / (1 - np.sqrt(pressure)) ** 1.5 * 1e6
    np.testing.assert_allclose(solid_conductance(simple(), pressure), theory, rtol=0.016)


def test_elastic_correlation_fits_the_theory_it_was_made_from() -> None:
    """Mikic 1974, whose spots have half the area of the overlapping parts."""
    pressure = erfc(LAMBDA / np.sqrt(2)) / 4
    theory = np.exp(-(LAMBDA**2) / 2) / (4 * np.sqrt(np.pi)) / (1 - np.sqrt(pressure)) ** 1.5 * 1e6
    np.testing.assert_allclose(solid_conductance(simple(elastic_share=1.0), pressure), theory, rtol=0.06)
    np.testing.assert_allclose(
        solid_conductance(simple(elastic_share=1.0), pressure[LAMBDA < 4.3]), theory[LAMBDA < 4.3], rtol=0.021
    )


def test_gap_agrees_with_yovanovichs_power_law_where_that_fits() -> None:
    pressure = np.geomspace(1e-4, 1e-2, 21)
    gap = 1 / gas_conductance(simple(gas_conductivity=1.0), pressure)
    np.testing.assert_allclose(gap, 1.53e-6 * pressure**-0.097, rtol=0.04)


@pytest.mark.parametrize(
    ("surface", "pressure", "least", "most"),
    [
        # Incropera & DeWitt, table 3.1a (after Fried 1969): contact resistance in vacuum, 1e-4 m2 K/W
        (metal(16.2, 193e9, 3.0e9, 1.5e-6), 1e5, 6.0, 25.0),
        (metal(16.2, 193e9, 3.0e9, 1.5e-6), 1e7, 0.7, 4.0),
        (metal(398.0, 117e9, 1.2e9, 3e-6), 1e5, 1.0, 10.0),
        (metal(398.0, 117e9, 1.2e9, 3e-6), 1e7, 0.1, 0.5),
        (metal(180.0, 70e9, 1.2e9, 3e-6), 1e5, 1.5, 5.0),
        (metal(180.0, 70e9, 1.2e9, 3e-6), 1e7, 0.2, 0.4),
    ],
)
def test_vacuum_resistances_of_metal_pairs_are_of_the_published_size(
    surface: Surface, pressure: float, least: float, most: float
) -> None:
    """The table gives neither finish nor flatness; within a factor of five of its range for usual ground faces."""
    resistance = 1e4 / float(contact_conductance(joint(surface, surface, gas=None), pressure))
    assert least / 5 < resistance < most * 5


@pytest.mark.parametrize(
    ("surface", "pressure", "published"),
    [
        # Holman, Heat Transfer, table 2-3: ground pairs in air, roughness given, 1e-4 m2 K/W
        (metal(24.9, 200e9, 3.0e9, 2.54e-6), 1e6, 2.64),  # stainless steel 416, 0.3 to 2.5 MPa
        (metal(390.0, 117e9, 1.2e9, 1.27e-6), 5e6, 0.07),  # copper, 1.2 to 20 MPa
        (metal(180.0, 70e9, 1.2e9, 2.54e-6), 1.8e6, 0.88),  # aluminium, 1.2 to 2.5 MPa
        (metal(180.0, 70e9, 1.2e9, 0.25e-6), 1.8e6, 0.18),
        # Incropera & DeWitt, table 3.1b: aluminium, 10 um, air
        (metal(180.0, 70e9, 1.2e9, 10e-6), 1e5, 2.75),
    ],
)
def test_resistances_in_air_are_of_the_published_size(
    surface: Surface, pressure: float, published: float
) -> None:
    """Real faces are wavy besides, and slopes and hardnesses are usual ones: within a factor of four."""
    resistance = 1e4 / float(contact_conductance(joint(surface, surface), pressure))
    assert published / 4 < resistance < published * 4


def test_gas_parameter_of_air() -> None:
    """Of the order of four mean free paths: 0.37 um is Yovanovich's (1981) round figure for air."""
    assert 0.25e-6 < AIR.jump < 0.4e-6
    viscosity = 1.846e-5  # Incropera & DeWitt, table A.4
    assert viscosity / 101325 * np.sqrt(np.pi * 287 * 300 / 2) == pytest.approx(AIR.mean_free_path, rel=2e-3)


def test_joint_combines_the_faces() -> None:
    pair = joint(STEEL, LAPPED_ALUMINA)
    assert pair == joint(LAPPED_ALUMINA, STEEL)
    assert pair.conductivity == pytest.approx(2 / (1 / 16.2 + 1 / 25))
    assert pair.roughness == pytest.approx(np.sqrt(1e-12 + 0.16e-12))
    assert pair.hardness == 3e9
    modulus = 1 / ((1 - 0.09) / 193e9 + (1 - 0.22**2) / 372e9)
    assert pair.elastic_hardness == pytest.approx(modulus * pair.slope / np.sqrt(2))


def test_plasticity_index_chooses_the_law() -> None:
    assert joint(STEEL, LAPPED_ALUMINA).elastic_share == 0
    assert joint(RUBBER, LAPPED_ALUMINA).elastic_share == 1
    pairs = [joint(metal(1, 1e9, h, 1e-6), LAPPED_ALUMINA) for h in np.geomspace(1e7, 1e10, 60)]
    shares = np.asarray(stack_joints(pairs).elastic_share)
    assert shares[0] == 0 and shares[-1] == 1 and (np.diff(shares) >= 0).all()


@pytest.mark.parametrize("face", [STEEL, RUBBER, metal(0.2, 3e9, 2e8, 1e-6)])
def test_grows_with_pressure_from_the_gas_alone(face: Surface) -> None:
    pair = joint(face, LAPPED_ALUMINA)
    values = contact_conductance(pair, PRESSURES)
    assert (np.diff(values) > 0).all()
    touching = float(contact_conductance(pair, 0.0))
    assert solid_conductance(pair, 0.0) == 0
    assert touching == pytest.approx(AIR.conductivity / (4.75 * float(pair.roughness) + AIR.jump), rel=1e-9)
    assert float(contact_conductance(pair, 1e-9)) == pytest.approx(touching, rel=1e-6)
    assert contact_conductance(joint(face, LAPPED_ALUMINA, gas=None), 0.0) == 0


def test_exponents_in_pressure() -> None:
    for share, exponent in ((0.0, 0.95), (1.0, 0.94)):
        values = solid_conductance(simple(elastic_share=share), np.array([1e-5, 1e-3]))
        assert np.log(values[1] / values[0]) / np.log(100) == pytest.approx(exponent)


def test_separation_at_a_known_pressure() -> None:
    gap = 1 / float(gas_conductance(simple(gas_conductivity=1.0, jump=1e-7), 1e-3))
    assert gap == pytest.approx(1e-6 * np.sqrt(2) * erfcinv(2e-3) + 1e-7)


def test_smoother_faces_conduct_better() -> None:
    values = [
        float(contact_conductance(joint(metal(16, 2e11, 3e9, r), LAPPED_ALUMINA), 2e4))
        for r in (0.2e-6, 1e-6, 5e-6)
    ]
    assert values[0] > values[1] > values[2]


def test_a_row_does_not_depend_on_the_others() -> None:
    pairs = [joint(face, LAPPED_ALUMINA) for face in (STEEL, RUBBER, metal(0.2, 3e9, 2e8, 1e-6))] * 11
    pressure = np.random.default_rng(1).uniform(0, 1e6, (33, 2))
    batch = contact_conductance(stack_joints(pairs), pressure[:, 0])
    single = [float(contact_conductance(pair, p)) for pair, p in zip(pairs, pressure[:, 0], strict=True)]
    assert batch.tolist() == single


def test_surface_of_a_material() -> None:
    full = Material("m", 1, 1, 1, youngs_modulus=1e9, roughness=1e-6, poisson_ratio=0.4, microhardness=1e8)
    face = Surface.of(full)
    assert (face.slope, face.poisson_ratio, face.microhardness) == (typical_slope(1e-6), 0.4, 1e8)
    assert Surface.of(Material("m", 1, 1, 1, youngs_modulus=1e9, roughness=1e-6)).microhardness == np.inf
    with pytest.raises(InvalidValueError, match="m has no youngs_modulus"):
        Surface.of(Material("m", 1, 1, 1, roughness=1e-6))
    with pytest.raises(InvalidValueError, match="m has no roughness"):
        Surface.of(Material("m", 1, 1, 1, youngs_modulus=1e9))


@pytest.mark.parametrize("pressure", [-1.0, np.nan, np.inf])
def test_refuses_pressures_that_are_none(pressure: float) -> None:
    with pytest.raises(InvalidValueError, match="pressure"):
        contact_conductance(joint(STEEL, LAPPED_ALUMINA), np.array([1e4, pressure]))


def test_refuses_impossible_surfaces() -> None:
    with pytest.raises(InvalidValueError, match="roughness"):
        Surface(1, 0, 0.1, 1e9)
    with pytest.raises(InvalidValueError, match="poisson"):
        Surface(1, 1e-6, 0.1, 1e9, 0.6)
    with pytest.raises(InvalidValueError, match="microhardness"):
        Surface(1, 1e-6, 0.1, 1e9, 0.3, -1)
