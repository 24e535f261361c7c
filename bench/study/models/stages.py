"""Stages of what is computed from a study, as whoever waits for it is told of them."""

READING = "Reading the trials"
FILTERING = "Filtering them"
FITTING = "Fitting the model"
JUDGING = "Judging it on trials that it was not fitted to"
COMPARING = "Comparing with every trial"
INTERVALS = "Finding how sure its parameters are"
DIAGNOSING = "Looking for what is missing"
SIMULATING = "Running every trial that the bench can do on the model's joint"
CHOOSING = "Choosing those that tell most"
MOVING = "Moving the model's joint through every trial"
TAKING_IN = "Adding what was recorded"
SUGGESTING = "Looking for what to record next"

LOADED = (READING, FILTERING)
COMPARISON = (*LOADED, FITTING, COMPARING, INTERVALS)
CHANGE = (*LOADED, FITTING, JUDGING)
SUGGESTION = (*LOADED, FITTING, DIAGNOSING, SIMULATING, CHOOSING)
UNITS = (*LOADED, FITTING)
CLOSED_LOOP = (*LOADED, FITTING, MOVING)
ROUND = (TAKING_IN, SUGGESTING)
REPORT = (COMPARING, MOVING, DIAGNOSING, SUGGESTING)
