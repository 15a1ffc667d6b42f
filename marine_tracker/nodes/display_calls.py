"""Calls of the tracker's services whose answer a viewer waits for; all in the node's executor."""

from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from typing import Any


def call(client: Any, request: Any, answer: Future[str], read: Callable[[Any], str]) -> None:
    """read(response) gives the answer, or raises ValueError. ValueError where nobody serves."""
    if not client.service_is_ready():
        raise ValueError(f'no tracker serves {client.srv_name}')

    def finish(done: Any) -> None:
        try:
            settle(answer, read(done.result()))
        except ValueError as error:
            settle(answer, error)

    asked = client.call_async(request)
    asked.add_done_callback(finish)
    # Who asked does not wait for ever: what is not answered by then is forgotten.
    answer.add_done_callback(
        lambda done: client.remove_pending_request(asked) if done.cancelled() else None
    )


def chain(
    first: Callable[[Future[str]], None], answer: Future[str], go_on: Callable[[str], None]
) -> None:
    """first(future) begins a call; go_on(its answer) goes on; what goes wrong is the answer."""
    taken: Future[str] = Future()

    def carry_on(done: Future[str]) -> None:
        try:
            go_on(done.result())
        except (ValueError, CancelledError) as error:
            settle(answer, error)

    taken.add_done_callback(carry_on)
    answer.add_done_callback(lambda done: taken.cancel() if done.cancelled() else None)
    first(taken)


def settle(answer: Future[str], result: str | BaseException) -> None:
    """The answer, unless whoever asked has given up meanwhile."""
    if not answer.set_running_or_notify_cancel():
        return
    if isinstance(result, BaseException):
        answer.set_exception(result)
    else:
        answer.set_result(result)


def told(response: Any) -> str:
    """The message of a Trigger or SetBool; ValueError with it where it did not succeed."""
    if not response.success:
        raise ValueError(response.message)
    return str(response.message)


def taken(response: Any) -> str:
    """'taken' where all parameters were set; ValueError with the reason where one was not."""
    for result in response.results:
        if not result.successful:
            raise ValueError(result.reason)
    return 'taken'
