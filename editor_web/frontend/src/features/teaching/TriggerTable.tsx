/** What the buttons do: the triggers of the Helping Hand as a table and as YAML, and which fires just now. */
import { SegmentedControl, Textarea } from '@mantine/core'
import { IconPencil, IconPlus, IconTrash } from '@tabler/icons-react'
import { useQueryClient } from '@tanstack/react-query'
import { useState } from 'react'
import { ServerError, wordsOf } from '../../api/client'
import { useAnswer } from '../../api/queryClient'
import { teach, triggerDocumentQuery, useDisabledReason, useTeach } from '../../api/teaching'
import type { Trigger, TriggerStatus } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { Empty } from '../../components/Empty'
import { CALLBACK_WORDS, TYPE_WORDS } from './triggerWords'
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
    <div className="triggers">
      <SegmentedControl
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
    </div>
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
        <div className="trigger-scroll" tabIndex={0} role="region" aria-label="Triggers">
          <table className="trigger-table">
            <thead>
              <tr>
                <th scope="col">Trigger</th>
                <th scope="col">Arm</th>
                <th scope="col">Topic</th>
                <th scope="col">Type</th>
                <th scope="col">Value</th>
                <th scope="col">Callback</th>
                <th scope="col">
                  <span className="visually-hidden">Edit</span>
                </th>
              </tr>
            </thead>
            <tbody>
              {triggers.map(({ trigger, pressed, fault }, at) => (
                <tr key={trigger.trig_name} className={pressed ? 'is-pressed' : ''}>
                  <th scope="row">
                    <span
                      className={`trigger-light${pressed ? ' is-on' : ''}`}
                      role="img"
                      aria-label={pressed ? 'pressed' : 'not pressed'}
                    />
                    {trigger.trig_name}
                    {fault && <span className="trigger-fault">{fault}</span>}
                  </th>
                  <td>{trigger.robot_ns || 'the only one'}</td>
                  <td className="mono">{trigger.trig_topic}</td>
                  <td>{TYPE_WORDS[trigger.trig_type]}</td>
                  <td className="mono">{JSON.stringify(trigger.trig_value)}</td>
                  <td>{CALLBACK_WORDS[trigger.trig_callback]}</td>
                  <td className="trigger-commands">
                    <CommandButton
                      label={`Edit ${trigger.trig_name}`}
                      isCompact
                      icon={<IconPencil size={14} aria-hidden />}
                      tone="quiet"
                      obstacle={off}
                      onPress={() => setEdited({ at, trigger })}
                    />
                    <CommandButton
                      label={`Remove ${trigger.trig_name}`}
                      isCompact
                      icon={<IconTrash size={14} aria-hidden />}
                      tone="quiet"
                      obstacle={off}
                      onPress={() => void keep(all.filter((_, index) => index !== at))}
                    />
                  </td>
                </tr>
              ))}
            </tbody>
          </table>
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
        <CommandButton
          label="Add a trigger"
          icon={<IconPlus size={15} aria-hidden />}
          obstacle={off}
          onPress={() => setEdited({ at: all.length, trigger: { ...NEW, robot_ns: arms[0] ?? '' } })}
        />
      )}
      {problem && (
        <p className="teach-problem" role="alert">
          {problem}
        </p>
      )}
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
    <div className="trigger-text">
      <Textarea
        label={kept?.file ? `Triggers in ${kept.file}` : 'Triggers'}
        value={text}
        onChange={(event) => setText(event.currentTarget.value)}
        autosize
        minRows={10}
        maxRows={24}
        spellCheck={false}
        classNames={{ input: 'mono' }}
      />
      <div className="command-row">
        <CommandButton
          label="Save the YAML"
          tone="strong"
          obstacle={off ?? (text === kept?.text ? 'nothing is changed' : undefined)}
          onPress={save}
        />
        <span className="quiet" role="status" aria-label="Saving the triggers">
          {message}
        </span>
      </div>
      {problem && (
        <p className="teach-problem" role="alert">
          {problem}
        </p>
      )}
    </div>
  )
}

/** A refusal with its line. */
function placed(error: unknown): string {
  if (!(error instanceof ServerError)) return wordsOf(error)
  const place = /:(\d+):(\d+)$/.exec(error.body.where)
  return `${place ? `Line ${place[1]}, column ${place[2]}: ` : ''}${wordsOf(error)}`
}
