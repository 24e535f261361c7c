"""Routes of studies: made and changed, checked, carried on in rounds, and what is computed from them."""

from typing import Annotated

from fastapi import Path

StudyId = Annotated[int, Path(ge=1, description="number of the study")]
