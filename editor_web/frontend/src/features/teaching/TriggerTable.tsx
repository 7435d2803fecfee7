/** What the buttons do: the triggers of the Helping Hand as a table and as YAML, and which fires just now. */
import { Group, SegmentedControl, Stack, Table, Text, Textarea, VisuallyHidden } from '@mantine/core'
import { IconPencil, IconPlus, IconTrash } from '@tabler/icons-react'
import { useQueryClient } from '@tanstack/react-query'
import { useState } from 'react'
import { ServerError, wordsOf } from '../../api/client'
import { useAnswer } from '../../api/queryClient'
import { teach, triggerDocumentQuery, useDisabledReason, useTeach } from '../../api/teaching'
import type { Trigger, TriggerStatus } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { Empty } from '../../components/Empty'
import { RowTool } from '../../components/RowTool'
import { Refusal } from '../../components/Refusal'
import { CALLBACK_WORDS, TYPE_WORDS } from './triggerWords'
import classes from './Triggers.module.css'
import { TriggerForm } from './TriggerForm'

const NEW: Trigger = {
  trig_name: '',
  robot_ns: '',
  trig_topic: 'buttons/keyboard/play_pause',
  trig_type: 'rising_edge',
  trig_callback: 'joint_save',
  trig_value: true,
  field: '',
  joint_dmp_N: 0,
  source_frame: '',
  target_frame: 'world',
}

export function TriggerTable({ arms }: { readonly arms: readonly string[] }) {
  const [isText, setText] = useState(false)
  const hand = useTeach((s) => s.hand)
  if (hand === null) return <Empty title="No Helping Hand">This server was started without one.</Empty>
  return (
    <Stack gap="xs">
      <SegmentedControl
        style={{ alignSelf: 'flex-start' }}
        size="xs"
        aria-label="How the triggers are shown"
        value={isText ? 'yaml' : 'table'}
        onChange={(value) => setText(value === 'yaml')}
        data={[
          { value: 'table', label: 'Table' },
          { value: 'yaml', label: 'YAML' },
        ]}
      />
      {isText ? <TriggerText /> : <Rows arms={arms} triggers={hand?.triggers ?? []} />}
    </Stack>
  )
}

function Rows({ arms, triggers }: { readonly arms: readonly string[]; readonly triggers: readonly TriggerStatus[] }) {
  const [edited, setEdited] = useState<{ readonly at: number; readonly trigger: Trigger }>()
  const [problem, setProblem] = useState('')
  const off = useDisabledReason()

  async function keep(next: readonly Trigger[]): Promise<boolean> {
    try {
      await teach.setTriggers(next)
      setProblem('')
      setEdited(undefined)
      return true
    } catch (error) {
      setProblem(wordsOf(error))
      return false
    }
  }

  const all = triggers.map((each) => each.trigger)
  return (
    <>
      {triggers.length === 0 ? (
        <Empty title="No button does anything yet">Add a trigger: its topic, and the action and arm that it triggers.</Empty>
      ) : (
        <div className={classes.scroll} tabIndex={0} role="region" aria-label="Triggers">
          <Table fz="xs" verticalSpacing={4} horizontalSpacing={6}>
            <Table.Thead>
              <Table.Tr>
                <Table.Th scope="col">Trigger</Table.Th>
                <Table.Th scope="col">Arm</Table.Th>
                <Table.Th scope="col">Topic</Table.Th>
                <Table.Th scope="col">Type</Table.Th>
                <Table.Th scope="col">Value</Table.Th>
                <Table.Th scope="col">Callback</Table.Th>
                <Table.Th scope="col">
                  <VisuallyHidden>Edit</VisuallyHidden>
                </Table.Th>
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {triggers.map(({ trigger, pressed, fault }, at) => (
                <Table.Tr key={trigger.trig_name} {...(pressed && { bg: 'var(--active-soft)' })}>
                  <Table.Th scope="row">
                    <span
                      className={classes.light}
                      data-pressed={pressed || undefined}
                      role="img"
                      aria-label={pressed ? 'pressed' : 'not pressed'}
                    />
                    {trigger.trig_name}
                    {fault && (
                      <Text size="xs" c="var(--failed)">
                        {fault}
                      </Text>
                    )}
                  </Table.Th>
                  <Table.Td>{trigger.robot_ns || 'the only one'}</Table.Td>
                  <Table.Td ff="monospace">{trigger.trig_topic}</Table.Td>
                  <Table.Td>{TYPE_WORDS[trigger.trig_type]}</Table.Td>
                  <Table.Td ff="monospace">{JSON.stringify(trigger.trig_value)}</Table.Td>
                  <Table.Td>{CALLBACK_WORDS[trigger.trig_callback]}</Table.Td>
                  <Table.Td>
                    <Group gap={4} wrap="nowrap">
                      <RowTool label={`Edit ${trigger.trig_name}`} obstacle={off} onPress={() => setEdited({ at, trigger })}>
                        <IconPencil size={14} aria-hidden />
                      </RowTool>
                      <RowTool
                        label={`Remove ${trigger.trig_name}`}
                        obstacle={off}
                        onPress={() => void keep(all.filter((_, index) => index !== at))}
                      >
                        <IconTrash size={14} aria-hidden />
                      </RowTool>
                    </Group>
                  </Table.Td>
                </Table.Tr>
              ))}
            </Table.Tbody>
          </Table>
        </div>
      )}
      {edited ? (
        <TriggerForm
          key={edited.at}
          arms={arms}
          trigger={edited.trigger}
          taken={all.filter((_, index) => index !== edited.at).map((each) => each.trig_name)}
          onCancel={() => setEdited(undefined)}
          onKeep={(trigger) =>
            void keep(edited.at < all.length ? all.map((each, index) => (index === edited.at ? trigger : each)) : [...all, trigger])
          }
        />
      ) : (
        <Group>
          <CommandButton
            label="Add a trigger"
            icon={<IconPlus size={15} aria-hidden />}
            obstacle={off}
            onPress={() => setEdited({ at: all.length, trigger: { ...NEW, robot_ns: arms[0] ?? '' } })}
          />
        </Group>
      )}
      <Refusal>{problem}</Refusal>
    </>
  )
}

function TriggerText() {
  const client = useQueryClient()
  const { value: kept, problem: unread } = useAnswer(triggerDocumentQuery())
  const [typed, setText] = useState<string>()
  const [refusal, setProblem] = useState('')
  const [message, setMessage] = useState('')
  const off = useDisabledReason()
  const text = typed ?? kept?.text ?? ''
  const problem = refusal || unread

  function save(): void {
    teach.writeDocument(text).then(
      () => {
        setProblem('')
        setMessage('Saved, and in force.')
        if (kept) client.setQueryData(triggerDocumentQuery().queryKey, { ...kept, text })
      },
      (error: unknown) => {
        setMessage('')
        setProblem(placed(error))
      },
    )
  }

  return (
    <Stack gap="xs">
      <Textarea
        label={kept?.file ? `Triggers in ${kept.file}` : 'Triggers'}
        value={text}
        onChange={(event) => setText(event.currentTarget.value)}
        autosize
        minRows={10}
        maxRows={24}
        spellCheck={false}
        styles={{ input: { fontFamily: 'var(--mantine-font-family-monospace)' } }}
      />
      <Group gap="xs">
        <CommandButton
          label="Save the YAML"
          tone="strong"
          obstacle={off ?? (text === kept?.text ? 'nothing is changed' : undefined)}
          onPress={save}
        />
        <Text span size="sm" c="dimmed" role="status" aria-label="Saving the triggers">
          {message}
        </Text>
      </Group>
      <Refusal>{problem}</Refusal>
    </Stack>
  )
}

/** A refusal with its line. */
function placed(error: unknown): string {
  if (!(error instanceof ServerError)) return wordsOf(error)
  const place = /:(\d+):(\d+)$/.exec(error.body.where)
  return `${place ? `Line ${place[1]}, column ${place[2]}: ` : ''}${wordsOf(error)}`
}
