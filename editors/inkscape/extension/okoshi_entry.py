"""What the entries of Inkscape's menu *Extensions → Okoshi* share."""

from okoshi_cache import Failed
from okoshi_messages import show_message
from okoshi_program import Missing

import inkex


class Entry(inkex.EffectExtension):
    """An entry of the menu, implemented by `do`. Shows errors as messages."""

    def effect(self):
        try:
            self.do()
        except (Missing, Failed) as error:
            self.fail(str(error))

    def fail(self, message):
        """Shows why nothing was done."""
        show_message(message)

    def do(self):
        raise NotImplementedError
