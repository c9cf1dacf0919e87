"""The physical models: closed forms, published values, and what their constructors refuse."""

import math
from dataclasses import FrozenInstanceError, asdict, replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hoverslam_lib import EARTH, FALCON_9, FALCON_9_LANDING_BURN, MARS, MOON, Booster, Descent, Oscillator, Planet, fly
from hoverslam_lib.data import load

SPRINGS = [
    {},
    {"v0": -2.0},
    {"stiffness": 2.5, "mass": 0.4, "x0": -1.2, "v0": 0.7},
    {"stiffness": 0.3, "mass": 5.0, "x0": 0.0, "v0": 1.0},
]


# ---- oscillator -------------------------------------------------------------------------------------------------


def test_the_default_oscillator_is_that_of_listing_2():
    spring = Oscillator()
    assert (spring.stiffness, spring.mass, spring.x0, spring.v0) == (1, 1, 3, 0)
    assert spring.period == pytest.approx(2 * math.pi, rel=1e-15)


@pytest.mark.parametrize("given", SPRINGS)
def test_the_exact_solution_solves_the_equation(given):
    spring = Oscillator(**given)
    x0, v0 = given.get("x0", 3.0), given.get("v0", 0.0)
    ratio = given.get("stiffness", 1.0) / given.get("mass", 1.0)
    t = np.linspace(0, 15, 101)
    reference = solve_ivp(
        lambda t, y: [y[1], -ratio * y[0]], (0, 15), [x0, v0], method="DOP853", rtol=1e-13, atol=1e-13, t_eval=t
    )
    assert spring.exact(0.0) == (x0, v0)
    np.testing.assert_allclose(spring.exact(t), reference.y, rtol=0, atol=2e-11)
    assert spring.exact(7.5) == pytest.approx(reference.y[:, 50], abs=2e-11)
    assert spring.acceleration(1.0, 0.7, 99.0) == pytest.approx(-ratio * 0.7, rel=1e-15)


@pytest.mark.parametrize("given", SPRINGS)
def test_energy_is_constant_along_the_exact_solution(given):
    spring = Oscillator(**given)
    energy = spring.energy(*spring.exact(np.linspace(0, 100, 1001)))
    by_hand = (spring.mass * spring.v0**2 + spring.stiffness * spring.x0**2) / 2
    np.testing.assert_allclose(energy, by_hand, rtol=2e-15)


@pytest.mark.parametrize("given", SPRINGS)
def test_the_exact_solution_returns_after_a_period(given):
    spring = Oscillator(**given)
    assert spring.period == pytest.approx(2 * math.pi * math.sqrt(spring.mass / spring.stiffness), rel=1e-15)
    assert spring.exact(spring.period) == pytest.approx((spring.x0, spring.v0), abs=2e-14)


# ---- planet -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("planet", "published"),
    # NASA's planetary fact sheets: without rotation, at the equator for the Earth, mean for the others
    [(EARTH, "9.798"), (MARS, "3.73"), (MOON, "1.62")],
    ids=["Earth", "Mars", "Moon"],
)
def test_gravity_at_the_surface_is_the_published_one(planet, published):
    decimals = len(published.partition(".")[2])
    assert f"{planet.gravity(0.0):.{decimals}f}" == published


@pytest.mark.parametrize("planet", [EARTH, MARS, MOON], ids=["Earth", "Mars", "Moon"])
def test_gravity_falls_with_the_square_of_the_distance(planet):
    assert planet.gravity(planet.radius) == pytest.approx(planet.gravity(0.0) / 4, rel=1e-15)
    assert planet.gravity(-planet.radius / 2) == pytest.approx(planet.gravity(0.0) * 4, rel=1e-15)


@pytest.mark.parametrize(
    ("planet", "surface_density", "scale_height"), [(EARTH, 1.3, 8400), (MARS, 0.020, 11100)], ids=["Earth", "Mars"]
)
def test_density_falls_by_a_factor_e_over_each_scale_height(planet, surface_density, scale_height):
    heights = scale_height * np.array([-1.0, 0.0, 1.0, 10.0])
    expected = surface_density * np.array([math.e, 1, 1 / math.e, math.exp(-10)])
    np.testing.assert_allclose(planet.air_density(heights), expected, rtol=5e-15)


@pytest.mark.parametrize("h", [-1e9, -1e7, 0.0, 1e5])
def test_the_moon_has_no_air_at_any_height(h):
    assert MOON.air_density(h) == 0
    np.testing.assert_array_equal(MOON.air_density(np.array([h, h])), [0, 0])


@pytest.mark.parametrize("planet", [EARTH, MARS, MOON], ids=["Earth", "Mars", "Moon"])
@pytest.mark.parametrize("law", ["gravity", "air_density"])
def test_a_planet_gives_floats_for_floats_and_the_same_values_for_arrays(planet, law):
    heights = np.array([[-500.0, 0.0, 123.4], [1e4, 86e3, 150e3]])
    function = getattr(planet, law)
    floats = [[function(float(h)) for h in row] for row in heights]
    assert all(type(value) is float for row in floats for value in row)
    np.testing.assert_allclose(function(heights), floats, rtol=5e-16)


@pytest.mark.parametrize("planet", [EARTH, MOON], ids=["Earth", "Moon"])
def test_a_planet_that_was_asked_is_as_it_was_made(planet):
    planet.air_density(10.0)
    fly(Descent(planet=planet), None, dt=5.0)
    assert vars(planet) == asdict(planet)


@pytest.mark.parametrize(
    ("changed", "depth"),
    [({}, -16_800), ({"surface_density": 0.0}, -3_189_050), ({"scale_height": 1e7}, -3_189_050)],  # half the radius
)
def test_air_and_planet_can_be_continued_so_far_below_the_ground(changed, depth):
    planet = replace(EARTH, **changed)
    assert planet.deepest == depth
    assert type(planet.deepest) is float
    column = replace(EARTH, **{name: np.array([value, value]) for name, value in changed.items()})
    assert np.all(column.deepest == depth)


# ---- booster ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("burn_time", "mass"),
    [
        (-5.0, 57_200),
        (0.0, 57_200),
        (1.0, 55_720),
        (10, 42_400),
        (20.0, 27_600),
        (30_000 / 1480, 27_200),
        (99.0, 27_200),
    ],
)
def test_mass_falls_while_the_engine_burns_and_not_before_or_after(burn_time, mass):
    found = FALCON_9.mass(burn_time)
    assert found == pytest.approx(mass, rel=1e-15)
    assert type(found) is float
    np.testing.assert_allclose(FALCON_9.mass(np.full((2, 1), burn_time)), np.full((2, 1), mass), rtol=1e-15)


def test_what_follows_from_the_data_of_a_booster():
    assert FALCON_9.initial_mass == 57_200
    assert FALCON_9.burn_duration == pytest.approx(20.27, abs=0.005)  # as the paper's plots mark it
    assert FALCON_9.area == pytest.approx(math.pi * 1.83 * 1.83, rel=1e-15)
    # one Merlin 1D: 845 kN and 282 s are its thrust and specific impulse at sea level
    assert FALCON_9_LANDING_BURN.thrust == 845e3
    specific_impulse = FALCON_9_LANDING_BURN.thrust / FALCON_9_LANDING_BURN.burn_rate / 9.80665
    assert specific_impulse == pytest.approx(282, rel=1e-15)


def test_falcon_9_and_earth_have_the_constants_of_the_paper():
    constants = load("constants").set_index("symbol")["value"]
    symbols = {
        FALCON_9: {
            "dry_mass": "m_d",
            "propellant_mass": "m_p",
            "burn_rate": "b",
            "drag_coefficient": "C_D",
            "radius": "r",
        },
        EARTH: {"mass": "M", "radius": "R", "surface_density": "rho_0", "scale_height": "H"},
    }
    for model, names in symbols.items():
        assert {field: getattr(model, field) for field in names} == {f: constants[s] for f, s in names.items()}
    assert FALCON_9.thrust == 1000 * constants["T"]  # printed in kN
    assert EARTH.gravity(0.0) == pytest.approx(constants["G"] * constants["M"] / constants["R"] ** 2, rel=1e-15)


# ---- constructors -----------------------------------------------------------------------------------------------

# class, and for each field: a good value, its unit, its lower limit
CONSTRUCTORS = {
    Oscillator: {
        "stiffness": (1.0, "N/m", "above 0"),
        "mass": (1.0, "kg", "above 0"),
        "x0": (3.0, "m", None),
        "v0": (0.0, "m/s", None),
    },
    Planet: {
        "mass": (6e24, "kg", "above 0"),
        "radius": (6e6, "m", "above 0"),
        "surface_density": (1.3, "kg/m³", "from 0"),
        "scale_height": (8400.0, "m", "above 0"),
    },
    Booster: {
        "dry_mass": (27e3, "kg", "above 0"),
        "propellant_mass": (30e3, "kg", "above 0"),
        "burn_rate": (1480.0, "kg/s", "above 0"),
        "thrust": (7.6e6, "N", "above 0"),
        "drag_coefficient": (0.5, None, "from 0"),
        "radius": (1.83, "m", "above 0"),
    },
}
FIELDS = [
    (cls, field, unit, limit) for cls, fields in CONSTRUCTORS.items() for field, (_, unit, limit) in fields.items()
]


def build(cls, **changed):
    return cls(**{**{field: good for field, (good, _, _) in CONSTRUCTORS[cls].items()}, **changed})


@pytest.mark.parametrize(("cls", "field", "unit", "limit"), FIELDS)
@pytest.mark.parametrize(
    "value", [math.nan, math.inf, -math.inf, "1", None, True, 1j, [1.0], np.array([[1.0, 2.0]]), -1.0, 0.0], ids=repr
)
def test_a_bad_value_is_refused_with_name_value_unit_and_what_is_allowed(cls, field, unit, limit, value):
    if repr(value) in {"above 0": [], "from 0": ["0.0"], None: ["0.0", "-1.0"]}[limit]:
        build(cls, **{field: value})  # legal here
        return
    with pytest.raises(ValueError if isinstance(value, float) else TypeError) as caught:
        build(cls, **{field: value})
    message = str(caught.value)
    assert message.startswith(f"{field} must be a finite number")
    assert {"above 0": "greater than 0", "from 0": "at least 0", None: ""}[limit] in message
    assert unit is None or f"[{unit}]" in message
    assert f"got {value!r}" in message


@pytest.mark.parametrize("cls", CONSTRUCTORS)
def test_models_are_frozen(cls):
    model = build(cls)
    field = next(iter(CONSTRUCTORS[cls]))
    with pytest.raises(FrozenInstanceError):
        setattr(model, field, 2.0)


def test_a_planet_may_have_an_air_of_its_own():
    class Layered(Planet):
        def air_density(self, h):
            return 1.2 if h < 5e3 else 0.0

    layered = Descent(planet=Layered(**asdict(EARTH)))
    assert layered.drag(4e3, -100.0) == pytest.approx(1.2 / EARTH.surface_density * Descent().drag(0.0, -100.0))
    for f in (layered.acceleration(), layered.acceleration(throttle=1.0), layered.acceleration_when_dry()):
        assert f(0.0, 5.1e3, -100.0) == f(0.0, 5.1e3, 0.0) < f(0.0, 4.9e3, -100.0)


def test_booster_is_equal_to_no_planet_and_no_number():
    assert (FALCON_9 == 3) is False
    assert (FALCON_9 == EARTH) is False
    assert FALCON_9 != EARTH
