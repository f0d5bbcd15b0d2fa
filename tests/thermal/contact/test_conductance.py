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
    covered_share,
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


def test_spots_that_cover_the_face_conduct_no_more() -> None:
    soft = joint(RUBBER, LAPPED_ALUMINA, gas=None, full_contact=True)
    endless = joint(RUBBER, LAPPED_ALUMINA, gas=None)
    full = float(soft.elastic_hardness)
    pressure = full * np.geomspace(1e-3, 1e3, 61)
    found, spots = contact_conductance(soft, pressure), contact_conductance(endless, pressure)
    below = pressure <= full
    np.testing.assert_array_equal(found[below], spots[below])
    np.testing.assert_allclose(found[~below], contact_conductance(endless, full), rtol=1e-12)
    np.testing.assert_allclose(covered_share(soft, pressure), pressure / full, rtol=1e-12)


def test_full_contact_begins_where_waves_of_that_slope_are_pressed_flat() -> None:
    """Westergaard 1939: pi E' D/l for waves of amplitude D and length l, mean slope 4 D/l; within 12 % of H_e."""
    pair = joint(RUBBER, LAPPED_ALUMINA)
    modulus = pair.elastic_hardness * np.sqrt(2) / pair.slope
    assert np.pi * modulus * pair.slope / 4 == pytest.approx(pair.elastic_hardness, rel=0.12)


def test_full_contact_leaves_the_resistance_of_less_than_a_wave_of_bulk() -> None:
    """That of 1/1.55 lengths sigma/m, at any pressure beyond; the law of spots falls below any length."""
    jelly = Surface(0.6, 1e-6, 0.12, 2e3, 0.49)
    for full_contact, left in ((True, 1 / 1.55), (False, 0.01)):
        pair = joint(jelly, LAPPED_ALUMINA, gas=None, full_contact=full_contact)
        assert covered_share(pair, 1e5) > 100
        lengths = pair.conductivity / float(contact_conductance(pair, 1e5)) * pair.slope / pair.roughness
        assert lengths == pytest.approx(left, rel=1e-6) if full_contact else lengths < left


@pytest.mark.parametrize("widens", [1e-9, 1e-6, 1e-5, 1e-3])
def test_gas_between_faces_that_are_not_flat_is_its_mean_over_them(widens: float) -> None:
    """A crowned face: the gap widens with the square of the distance from the middle, by quadrature over the disc."""
    flat, crowned = (joint(STEEL, LAPPED_ALUMINA, flatness=w) for w in (0.0, widens))
    gap = AIR.conductivity / float(gas_conductance(flat, 1e4))
    x, weight = np.polynomial.legendre.leggauss(400)
    radius = (x + 1) / 2
    mean = np.sum(weight / 2 * 2 * radius * AIR.conductivity / (gap + widens * radius**2))
    assert float(gas_conductance(crowned, 1e4)) == pytest.approx(mean, rel=1e-6)
    assert float(solid_conductance(crowned, 1e4)) == float(solid_conductance(flat, 1e4))


def test_refuses_a_flatness_below_none() -> None:
    with pytest.raises(InvalidValueError, match="flatness"):
        joint(STEEL, LAPPED_ALUMINA, flatness=-1e-6)


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
