"""Results that are drawn."""

import pytest

import carom
from falling import BALL, DISC


@pytest.fixture(scope="session")
def ball(tmp_path_factory):
    directory = tmp_path_factory.mktemp("ball")
    carom.run(carom.Scenario.from_dict(BALL), out=directory)
    return directory


@pytest.fixture(scope="session")
def disc(tmp_path_factory):
    directory = tmp_path_factory.mktemp("disc")
    carom.run(carom.Scenario.from_dict(DISC), out=directory)
    return directory
