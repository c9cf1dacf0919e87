"""The tables in data/: complete, in the units they claim, found from anywhere; checked against sums and standards."""

import math

import pytest

from hoverslam_lib import METHODS, data

# name → rows, columns
TABLES = {
    "atmosphere_1976": (7, ["base [m]", "top [m]", "base temperature [K]", "lapse rate [K/m]"]),
    "atmosphere_1976_constants": (5, ["symbol", "name", "value", "unit", "source"]),
    "constants": (13, ["symbol", "name", "value", "unit", "source"]),
    "listing_3": (8, ["method", "quantity", "value", "unit"]),
    "optimisation_tables": (84, ["figure", "dt", "t_ignite", "method", "quantity", "value", "unit"]),
    "real_landings": (168, ["flight", "t [s]", "speed [m/s]", "height [m]"]),
    "text_values": (9, ["section", "method", "quantity", "value", "unit"]),
}


def test_the_folder_holds_these_tables_and_its_readme_names_each():
    assert sorted(path.stem for path in data.FOLDER.glob("*.csv")) == sorted(TABLES)
    readme = (data.FOLDER / "README.md").read_text(encoding="utf-8")
    assert all(f"`{name}.csv`" in readme for name in TABLES)


@pytest.mark.parametrize("name", TABLES)
def test_a_table_loads_from_any_working_directory_with_no_cell_missing(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    rows, columns = TABLES[name]
    table = data.load(name)
    assert list(table.columns) == columns
    assert len(table) == rows
    assert table.notna().all(axis=None)
    assert not table.duplicated().any()
    if "value" in columns:
        assert table["value"].dtype == float


@pytest.mark.parametrize("name", ["constant", "constants.csv", "../data/constants", "", None])
def test_an_unknown_table_is_refused_with_the_list_of_those_there_are(name):
    with pytest.raises(ValueError, match="there is no table") as caught:
        data.load(name)
    assert repr(name) in str(caught.value)
    assert all(known in str(caught.value) for known in TABLES)


def test_outside_a_checkout_the_message_says_what_to_do(monkeypatch, tmp_path):
    monkeypatch.setattr(data, "FOLDER", tmp_path / "data")
    with pytest.raises(FileNotFoundError, match=r"Clone the project.*pip install -r environment.txt") as caught:
        data.load("constants")
    assert str(tmp_path / "data") in str(caught.value)


@pytest.mark.parametrize("name", ["constants", "atmosphere_1976_constants"])
def test_constants_have_a_unit_a_source_and_one_row_each(name):
    table = data.load(name)
    assert table["symbol"].is_unique
    assert (table["unit"].str.strip() != "").all()
    assert (table["source"].str.len() > 5).all()


# ---- the paper's printed values ---------------------------------------------------------------------------------


def test_every_cell_of_figures_7_7_to_7_9_is_there_once():
    table = data.load("optimisation_tables")
    assert set(zip(table["figure"], table["dt"], strict=True)) == {(7.7, 0.02), (7.8, 0.05), (7.9, 0.1)}
    assert dict(table.groupby("quantity")["unit"].unique().map(list)) == {"height": ["m"], "velocity": ["m/s"]}
    columns = table.groupby(["figure", "method", "quantity"])
    assert len(columns) == 3 * 2 * 2
    for (_, method, _), column in columns:
        assert method in ("rkn4", "symplectic_euler")
        assert len(column) == 7
        assert column["t_ignite"].is_monotonic_increasing
        assert column["t_ignite"].is_unique


def test_printed_values_are_in_range():
    table = data.load("optimisation_tables")
    assert table["t_ignite"].between(35, 36).all()
    heights = table[table["quantity"] == "height"]
    assert heights["value"].between(0, 800).all()
    assert table[table["quantity"] == "velocity"]["value"].between(-200, 170).all()
    for _, column in heights.groupby(["figure", "method"]):  # a later ignition stops lower
        assert column["value"].is_monotonic_decreasing


@pytest.mark.parametrize(
    ("figure", "t_ignite", "sums"),
    [  # of each column as printed: Runge-Kutta h and v, symplectic Euler h and v
        (7.7, 249.78, (1178.5, -73.1, 1237.5, -436.82)),
        (7.8, 249.75, (1316.0, 487.5, 1448.0, -661.06)),
        (7.9, 249.0, (1869.5, -434.78, 2223.0, -532.32)),
    ],
)
def test_columns_of_the_printed_tables_sum_to_what_the_paper_prints(figure, t_ignite, sums):
    table = data.load("optimisation_tables")
    columns = table[table["figure"] == figure].groupby(["method", "quantity"])  # alphabetical: as in the paper
    assert columns["value"].sum().tolist() == pytest.approx(sums, abs=1e-9)
    assert columns["t_ignite"].sum().tolist() == pytest.approx([t_ignite] * 4, abs=1e-9)


def test_listing_3_and_the_text_name_known_methods():
    listing = data.load("listing_3")
    mape = listing[listing["quantity"] == "MAPE"].set_index("method")["value"]
    assert dict(mape) == {
        "rk4": 7.183196393916714e-09,
        "symplectic_euler": 2.2736460451955488e-06,
        "explicit_euler": 0.005631552584641939,
        "implicit_euler": 0.0034736158245725255,
    }
    steps = listing[listing["quantity"] == "step size"]
    assert sorted(steps["method"]) == sorted(mape.index)
    assert (steps["value"] == round(5 * math.pi / 156, 3)).all()
    assert set(data.load("text_values")["method"]) <= set(METHODS)


# ---- the U.S. Standard Atmosphere 1976 --------------------------------------------------------------------------


def standard_density(geopotential_height):
    """Density [kg/m³] from the defining layers: hydrostatic balance of an ideal gas, layer by layer."""
    constant = data.load("atmosphere_1976_constants").set_index("symbol")["value"]
    gas = constant["R*"] / constant["M_0"]
    pressure = constant["p_0"]
    for _, (base, top, temperature, lapse) in data.load("atmosphere_1976").iterrows():
        climb = min(top, geopotential_height) - base
        t = temperature + lapse * climb
        if lapse:
            pressure *= (temperature / t) ** (constant["g_0"] / (gas * lapse))
        else:
            pressure *= math.exp(-constant["g_0"] * climb / (gas * temperature))
        if geopotential_height <= top:
            return pressure / (gas * t)
    raise ValueError("above the layers")


@pytest.mark.parametrize(
    ("geopotential_height", "published"),  # NOAA-S/T 76-1562, Table I, to its five digits
    [
        (0, 1.2250),
        (11_000, 0.36392),
        (20_000, 0.088035),
        (32_000, 0.013225),
        (47_000, 0.0014275),
        (51_000, 8.6160e-4),
        (71_000, 6.4211e-5),
    ],
)
def test_the_layers_give_the_published_densities(geopotential_height, published):
    assert float(f"{standard_density(geopotential_height):.4e}") == pytest.approx(published, rel=1e-12)


def test_the_layers_are_contiguous_and_temperature_is_continuous():
    layers = data.load("atmosphere_1976")
    base, top, temperature, lapse = (layers[column] for column in layers)
    assert base[0] == 0
    assert top.iloc[-1] == 84_852
    assert base[1:].tolist() == top[:-1].tolist()
    assert (temperature + lapse * (top - base))[:-1].tolist() == pytest.approx(temperature[1:].tolist(), abs=1e-9)


# ---- three real landings ----------------------------------------------------------------------------------------

FLIGHTS = dict(list(data.load("real_landings").groupby("flight")))


def test_each_landing_has_every_second_from_before_the_burn_to_the_ground():
    assert set(FLIGHTS) == {"NROL-76", "CRS-11", "OTV-5"}
    for flight in FLIGHTS.values():
        assert flight["t [s]"].tolist() == list(range(-20, 36))
        assert flight[["speed [m/s]", "height [m]"]].ge(0).all(axis=None)


@pytest.mark.parametrize("name", FLIGHTS)
def test_a_booster_only_slows_down_and_sinks_and_ends_at_rest(name):
    flight = FLIGHTS[name].set_index("t [s]")
    assert flight["speed [m/s]"].diff()[1:].le(0).all()
    assert flight["height [m]"].diff()[1:].le(0).all()
    assert flight["speed [m/s]"].iloc[-1] <= 1
    assert flight["height [m]"].iloc[-1] <= 100


@pytest.mark.parametrize("name", FLIGHTS)
def test_speeds_fit_the_heights_in_metres_and_seconds(name):
    """In feet, km/h or another time they would not: a booster sinks no faster than it moves, and not much slower."""
    flight = FLIGHTS[name].set_index("t [s]")
    sunk = flight["height [m]"][-16] - flight["height [m]"][0]
    assert 0.85 < sunk / flight["speed [m/s]"].loc[-15:0].sum() < 1.0
    assert flight["speed [m/s]"][0] == pytest.approx(318, abs=2)  # at the start of the burn
    assert flight["speed [m/s]"][20] == pytest.approx(105, abs=5)


def test_columns_of_the_landings_sum_to_what_was_collected():
    sums = data.load("real_landings").groupby("flight")[["speed [m/s]", "height [m]"]].sum()
    assert sums.T.to_dict("list") == {
        "CRS-11": [14_638, 222_900],
        "NROL-76": [13_904, 217_500],
        "OTV-5": [13_491, 222_200],
    }
