"""The queue: experiments one after the other, and campaigns that fill it."""

from bench.runs.queue.campaign import Campaign, CampaignPlan, plan_campaign
from bench.runs.queue.conductor import Conductor
from bench.runs.queue.items import Order, checked_item, known_item
from bench.runs.queue.overview import QueueState, queue_state

__all__ = [
    "Campaign",
    "CampaignPlan",
    "Conductor",
    "Order",
    "QueueState",
    "checked_item",
    "known_item",
    "plan_campaign",
    "queue_state",
]
