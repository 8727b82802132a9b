#!/usr/bin/env python3
"""Closed form against a sweep of the frequency, and the sweep against energy in a simulation."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from rows import finish, unit

formula, swept = unit("hal/hal_test", "Passivity.TheClosedFormAgreesWithASweepOfTheFrequency")
energy, moved = unit("hal/hal_test", "Passivity.OnlyWhatIsNotPassiveGivesEnergyToAMovingOutput")
finish(f"{swept['disagreed']} disagreements in {swept['judged']} sets (1000 cascades); energy agrees in "
       f"{moved['agreed']} of 50", formula and energy and int(swept["disagreed"]) == 0 and int(moved["agreed"]) >= 48)
