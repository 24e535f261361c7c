"""ODrive's own message file (DBC, as `odrive-can` brings it) beside the bytes of the driver and of the simulated axis;
and that package's client on the simulated axis. Neither side of that conversation is our driver.
"""

import asyncio
import threading
import time
from contextlib import contextmanager, suppress
from struct import pack

import can
import pytest
from odrive_can.mock import ODriveCANMock
from odrive_can.odrive import ODriveCAN
from odrive_can.utils import get_dbc

from drivers.can_bus.settings import BusSettings
from drivers.contract import Command as Demand
from drivers.contract import Mode, Status
from drivers.odrive import protocol
from drivers.odrive.protocol import Command, can_id
from sim_backend.devices.odrive.serve import OdriveSimulation, serve_odrive
from tests.drivers.actuators.kinds import ODRIVE

DBC = get_dbc("odrive-cansimple-0.6.10")
NAMES = {
    Command.GET_VERSION: "Get_Version",
    Command.HEARTBEAT: "Heartbeat",
    Command.ESTOP: "Estop",
    Command.GET_ERROR: "Get_Error",
    Command.SET_AXIS_STATE: "Set_Axis_State",
    Command.GET_ENCODER_ESTIMATES: "Get_Encoder_Estimates",
    Command.SET_CONTROLLER_MODE: "Set_Controller_Mode",
    Command.SET_INPUT_TORQUE: "Set_Input_Torque",
    Command.GET_IQ: "Get_Iq",
    Command.GET_TEMPERATURE: "Get_Temperature",
    Command.GET_BUS: "Get_Bus_Voltage_Current",
    Command.CLEAR_ERRORS: "Clear_Errors",
}


def message(command, node=0):
    return DBC.get_message_by_name(f"Axis{node}_{NAMES[command]}")


@pytest.mark.parametrize("command", NAMES)
@pytest.mark.parametrize("node", [0, 3])
def test_identifiers(command, node):
    assert can_id(node, command) == message(command, node).frame_id


@pytest.mark.parametrize(
    ("command", "layout", "names"),
    [
        (Command.GET_ENCODER_ESTIMATES, protocol.PAIR, ("Pos_Estimate", "Vel_Estimate")),
        (Command.GET_IQ, protocol.PAIR, ("Iq_Setpoint", "Iq_Measured")),
        (Command.GET_TEMPERATURE, protocol.PAIR, ("FET_Temperature", "Motor_Temperature")),
        (Command.GET_BUS, protocol.PAIR, ("Bus_Voltage", "Bus_Current")),
        (Command.SET_INPUT_TORQUE, protocol.TORQUE, ("Input_Torque",)),
    ],
)
def test_layouts(command, layout, names):
    values = [1.5 + place for place in range(len(names))]
    decoded = message(command).decode(layout.pack(*values).ljust(8, b"\0"))
    assert [decoded[name] for name in names] == values


@pytest.mark.parametrize(
    ("command", "data"),
    [
        (Command.SET_AXIS_STATE, protocol.WORD.pack(protocol.IDLE)),
        (Command.SET_CONTROLLER_MODE, protocol.MODES.pack(protocol.TORQUE_CONTROL, protocol.PASSTHROUGH)),
        (Command.SET_INPUT_TORQUE, protocol.TORQUE.pack(0.1)),
        (Command.CLEAR_ERRORS, bytes(1)),
    ],
)
def test_what_is_sent_is_as_long_as_its_message_file_says(command, data):
    """A peer that reads by that file took none of our states while they were four bytes long."""
    assert len(data) == message(command).length


def test_states_modes_and_errors():
    state = message(Command.SET_AXIS_STATE).decode(protocol.WORD.pack(protocol.CLOSED_LOOP).ljust(8, b"\0"))
    assert str(state["Axis_Requested_State"]) == "CLOSED_LOOP_CONTROL"
    modes = message(Command.SET_CONTROLLER_MODE).decode(
        protocol.MODES.pack(protocol.TORQUE_CONTROL, protocol.PASSTHROUGH)
    )
    assert (str(modes["Control_Mode"]), str(modes["Input_Mode"])) == ("TORQUE_CONTROL", "PASSTHROUGH")
    errors = message(Command.GET_ERROR).get_signal_by_name("Active_Errors").choices
    names = {bit: str(name).lower().replace("_", " ") for bit, name in errors.items() if bit}
    ours = {bit: protocol.error_names(bit).replace("-", " ").replace("driver", "drv").lower() for bit in names}
    assert ours[0x01000000] == names[0x01000000] == "watchdog timer expired"
    assert {bit for bit, name in ours.items() if name.startswith("0x")} == set(), "an error without a name"


def test_its_heartbeat_says_the_state():
    data = pack("<IBBBB", 0x200, 8, 0, 1, 0)
    found = message(Command.HEARTBEAT).decode(data)
    assert str(found["Axis_State"]) == "CLOSED_LOOP_CONTROL"
    assert protocol.HEARTBEAT.unpack_from(data)[:2] == (0x200, 8)


@contextmanager
def mock_at_work(channel):
    """The package's mock of an axis: it knows no torque and no current, and changes its state half a second late."""
    loop, began = asyncio.new_event_loop(), threading.Event()

    async def work():
        mock = ODriveCANMock(0, can.Bus(interface="virtual", channel=channel, ignore_config=True))
        tasks = [asyncio.create_task(one()) for one in (mock.heartbeat_loop, mock.encoder_loop, mock.message_handler)]
        began.set()
        await asyncio.gather(*tasks)

    def run():
        with suppress(asyncio.CancelledError, RuntimeError):
            loop.run_until_complete(work())
        loop.close()

    def cancel():
        for task in asyncio.all_tasks(loop):
            task.cancel()

    thread = threading.Thread(target=run)
    thread.start()
    try:
        assert began.wait(10.0)
        yield
    finally:
        loop.call_soon_threadsafe(cancel)
        thread.join()


def test_our_driver_opens_and_drives_the_mock_of_another_package():
    with mock_at_work("odrive-mock"):
        drive = ODRIVE.on(BusSettings("virtual", "odrive-mock"), answer_timeout_s=1.0)  # it sleeps, and answers nothing
        drive.open(0.01)
        found = drive.describe()
        drive.enable(Mode.TORQUE)
        powered = drive.exchange(Demand(Mode.TORQUE, 0.01))
        drive.disable()
        off = drive.exchange(Demand(Mode.OFF))
        drive.close()
    assert (found.vendor, found.simulated) == ("ODrive", False)  # its mock says that it is released
    assert (powered.status, off.status) == (Status.ENABLED, Status.DISABLED)
    assert powered.supply_v == 0.0


def test_another_client_turns_the_simulated_axis():
    async def turn():
        bus = can.Bus(interface="virtual", channel="odrive-peer")
        client = ODriveCAN(axis_id=0, can_bus=bus)
        await client.start()
        try:
            await client.wait_for_heartbeat()
            before = (await client.get_encoder_estimates())["Pos_Estimate"]
            client.set_controller_mode("TORQUE_CONTROL", "PASSTHROUGH")
            await client.set_axis_state("CLOSED_LOOP_CONTROL")
            moved, deadline_s = 0.0, time.monotonic() + 5.0
            # on a busy machine the client hands out an estimate that came in before the torque
            while moved <= 0.05 and time.monotonic() < deadline_s:
                client.set_input_torque(0.015)
                await asyncio.sleep(0.01)
                moved = (await client.get_encoder_estimates())["Pos_Estimate"] - before
            # estimates that came in while one was handed out answer what is asked next: it keeps two at most
            answers = [await client.get_bus_voltage_current() for _ in range(3)]
            supply_v = next(answer["Bus_Voltage"] for answer in answers if "Bus_Voltage" in answer)
            await client.set_axis_state("IDLE")
            return moved, supply_v
        finally:
            client.stop()
            bus.shutdown()

    with serve_odrive(OdriveSimulation(interface="virtual", channel="odrive-peer", watchdog_s=None)):
        moved, supply_v = asyncio.run(turn())
    assert moved > 0.05
    assert supply_v == pytest.approx(24.0, abs=0.2)
