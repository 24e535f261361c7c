"""The rows that a plot of a trial needs: kept beside its blocks, and chosen when it is asked for."""
