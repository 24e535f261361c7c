"""Studies: compare a model with the measurement, diagnose what is missing, add it, watch the error fall.

Every function takes the store first and returns one of the models beside it or in `bench.study.models`; errors are
`bench.errors.BenchError`. It knows nothing of the service, the command line or the page.
"""
