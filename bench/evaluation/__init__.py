"""How good the product is: blind benchmark, challenge, figures of the paper, rivals, regression report, demo.

Nothing that runs a bench may import it, except the service, which offers challenges.
"""
