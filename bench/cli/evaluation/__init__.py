"""Commands that measure the product itself: demo, paper, figures, rivals, blind benchmark, regression report.

They parse words and print answers; the work is done in `bench.evaluation`.
"""
