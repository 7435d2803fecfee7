/** The last steps of the recovery: the release of the stop, and what becomes of the runs that it has ended. */
import { Button, Group, List, Text } from '@mantine/core'
import { Refusal } from '../../components/Refusal'
import { api } from '../../api/client'
import { recovery } from '../../api/recovery'
import { mayMoveDevices } from '../../api/realDevices'
import type { StoppedRun } from '../../api/types'
import { partWords, releaseObstacle, undecided } from '../../document/recovery'
import { fileTitle } from '../../document/path'
import { StepRow } from './ArmSteps'
import { Confirm } from './Confirm'
import { useStep, type StepProps } from './useStep'

export function ReleaseStep({ stop, mayOperate }: StepProps) {
  const command = useStep()
  const obstacle = releaseObstacle(stop)
  if (stop.phase === 'released') return <Text size="sm">Runs can start again.</Text>
  return (
    <>
      <Group gap="xs" justify="space-between">
        <Text size="sm">
          {obstacle ? `Not possible: ${obstacle}.` : 'Nothing moves by the release itself. Runs may be started afterwards.'}
        </Text>
        <Confirm
          label="Release the stop"
          title="Release the stop of the cell?"
          variant="filled"
          disabled={!mayOperate || obstacle !== undefined || command.busy !== ''}
          loading={command.busy !== ''}
          onConfirm={() => command.send('release', () => recovery.release(stop.number))}
        >
          <Text size="sm">After the release:</Text>
          <List size="sm" spacing={4}>
            <List.Item>Every operator of this server, and every program with its token, may start runs again.</List.Item>
            <List.Item>
              {stop.arms.length > 0
                ? `Runs may move ${stop.arms.map((arm) => arm.name).join(' and ')}`
                : 'Runs may move everything in the cell'}
              . Nobody may be within reach.
            </List.Item>
            {undecided(stop).map((arm) => (
              <List.Item key={arm.name}>
                {arm.name} still holds {partWords(arm.part)}: nobody has decided whether it keeps it.
              </List.Item>
            ))}
          </List>
        </Confirm>
      </Group>
      <Refusal>{command.problem}</Refusal>
    </>
  )
}

interface RunsStepProps extends StepProps {
  readonly onRun: (id: string) => void
  readonly onBehavior: (id: string) => void
}

export function RunsStep({ stop, mayOperate, onRun, onBehavior }: RunsStepProps) {
  const command = useStep()
  const isReleased = stop.phase === 'released'

  async function resume(run: StoppedRun): Promise<void> {
    if (!(await mayMoveDevices())) return
    const begin = { run: run.id, seq: run.seq, path: run.path }
    const started = await api.start({ behavior: run.behavior, parameters: {}, begin }, `recovery-${stop.number}-${run.id}`)
    onRun(started.run)
  }

  if (stop.runs.length === 0) return <Text size="sm">The stop has ended no run.</Text>
  return (
    <>
      {!isReleased && <Text size="sm">The stop has ended these runs. Release the stop first.</Text>}
      {stop.runs.map((run) => (
        <StepRow
          key={run.id}
          label={`Run ${run.id}`}
          tools={
            <>
              {run.path && (
                <Confirm
                  label="Resume"
                  title={`Start ${nameOf(run.behavior)} at ${run.path}?`}
                  disabled={!mayOperate || !isReleased || command.busy !== ''}
                  loading={command.busy === run.id}
                  onConfirm={() => command.send(run.id, () => resume(run))}
                >
                  <Text size="sm">
                    A new run starts at the state {run.path}, with the data and parameters of the stopped one. The arms are where they are
                    now: check that this state can start from there.
                  </Text>
                </Confirm>
              )}
              <Button size="xs" variant="default" disabled={!isReleased} onClick={() => onBehavior(run.behavior)}>
                Restart
              </Button>
            </>
          }
        >
          <strong>{nameOf(run.behavior)}</strong> {run.path ? `was stopped in ${run.path}` : 'was stopped before its first state'}
        </StepRow>
      ))}
      <Group justify="flex-end">
        <Button
          size="xs"
          variant="default"
          disabled={!mayOperate || !isReleased || command.busy !== ''}
          onClick={() => command.send('close', () => recovery.close())}
        >
          Leave {stop.runs.length === 1 ? 'it' : 'them'} ended
        </Button>
      </Group>
      <Refusal>{command.problem}</Refusal>
    </>
  )
}

function nameOf(behavior: string): string {
  return fileTitle(behavior)
}
