"""Studies: compare a model with the measurement, diagnose what is missing, add it, watch the error fall.

Every function takes the store first and returns one of the models beside it or in `bench.study.models`; errors are
`bench.errors.BenchError`. `model_id` says which model of the study is meant; None takes the newest. The room knows
nothing of the service, the command line or the page.
"""
