"""Examples of the documentation are tests too."""

import durer
