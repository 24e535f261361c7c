"""The stages of a diagnosis, as whoever waits for it is told of them."""

CHECKS = "Checking the data"
COLUMNS = "Computing what every effect would add"
SCREENING = "Screening the effects of steady sliding"
STEADY = "Refitting with the likeliest of them"
CHAIN = "Judging the measuring chain"
MEMORY = "Judging what acts near reversals"
REST = "Judging starts from rest"
LEFT = "Looking at what is left"
ALL = (CHECKS, COLUMNS, SCREENING, STEADY, CHAIN, MEMORY, REST, LEFT)
