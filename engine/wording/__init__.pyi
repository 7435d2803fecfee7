from engine.wording.misfit import explain_misfit as explain_misfit
from engine.wording.suggestions import did_you_mean as did_you_mean

__all__ = ["did_you_mean", "explain_misfit"]
