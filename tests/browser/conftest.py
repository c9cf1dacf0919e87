"""What the tests in a browser share."""

import driver
import pytest


@pytest.fixture(scope="module")
def chromium():
    try:
        with driver.browser() as browser:
            yield browser
    except driver.NoBrowser as missing:
        pytest.skip(str(missing))
