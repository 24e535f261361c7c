"""The queue: experiments one after the other, and campaigns that fill it."""
