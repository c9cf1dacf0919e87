"""The tables in the folder ``data/``: what the paper prints, constants, the standard atmosphere, real landings."""

from pathlib import Path

FOLDER = Path(__file__).resolve().parent.parent / "data"


def load(name):
    """Read a table of the folder ``data/``, whatever the working directory is.

    Parameters
    ----------
    name : str
        File name without ``.csv``; ``data/README.md`` lists them with their columns.

    Returns
    -------
    pandas.DataFrame

    Raises
    ------
    FileNotFoundError
        If the library was installed without its checkout.
    ValueError
        If there is no such table; the message lists those there are.
    """
    import pandas as pd

    if not FOLDER.is_dir():
        raise FileNotFoundError(
            f"there is no folder {FOLDER}: the tables are part of the course's checkout. Clone the project and install "
            "it from there with `pip install -r environment.txt`"
        )
    names = sorted(path.stem for path in FOLDER.glob("*.csv"))
    if not isinstance(name, str) or name not in names:
        raise ValueError(f"there is no table {name!r}; there are {', '.join(names)}")
    return pd.read_csv(FOLDER / f"{name}.csv")
