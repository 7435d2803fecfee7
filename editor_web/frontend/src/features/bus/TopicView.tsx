/** One topic: its traffic, its newest message as it changes, and a form where it takes commands. */
import type { Dict } from '../../document/dict'
import { Button, Group, Text } from '@mantine/core'
import { IconSend } from '@tabler/icons-react'
import { useState } from 'react'
import { bus, busQueries } from '../../api/bus'
import { wordsOf } from '../../api/client'
import { useAnswer } from '../../api/queryClient'
import { ValueTree } from '../../components/ValueTree'
import { Caution, Detail } from './Detail'
import { RequestForm } from './RequestForm'
import { useForm } from './useForm'
import { ageText, rateText } from './words'
import type { MessageFrame, TopicInfo, TopicMetrics } from '../../api/types'

interface TopicViewProps {
  readonly facts: TopicInfo
  readonly message: MessageFrame | undefined
  readonly traffic: TopicMetrics | undefined
  readonly mayChange: boolean
  readonly onBack: () => void
}

export function TopicView({ facts, message, traffic, mayChange, onBack }: TopicViewProps) {
  const heard = traffic?.subscribers === 1 ? '1 subscriber' : `${traffic?.subscribers ?? 0} subscribers`
  return (
    <Detail name={facts.name} type={facts.type} doc={facts.doc} onBack={onBack}>
      <Group gap="md" fz="0.8rem" c="dimmed" style={{ fontVariantNumeric: 'tabular-nums' }}>
        {[rateText(traffic), `latest ${ageText(traffic)}`, heard].map((words) => (
          <span key={words}>{words}</span>
        ))}
      </Group>
      {facts.takes_commands && <Publish topic={facts.name} mayChange={mayChange} />}
      {message?.problem ? (
        <Text fz="0.8rem" c="dimmed">
          There is no message: {message.problem}.
        </Text>
      ) : (
        message && <ValueTree label={`Latest message of ${facts.name}`} value={message.value} open={2} />
      )}
    </Detail>
  )
}

function Publish({ topic, mayChange }: { topic: string; mayChange: boolean }) {
  const form = useForm(useAnswer(busQueries.messageForm(topic)))
  const [refusal, setRefusal] = useState('')

  async function publish(message: Dict<unknown>): Promise<void> {
    setRefusal('')
    await bus.publish(topic, message).catch((error: unknown) => setRefusal(wordsOf(error)))
  }

  return (
    <>
      <Caution mayChange={mayChange} words="This topic accepts commands: publishing may move the robot." />
      <RequestForm
        label={`Publish on ${topic}`}
        form={form}
        isOff={!mayChange}
        onSend={(message) => void publish(message)}
        refusal={refusal}
        buttons={
          <Button type="submit" size="xs" disabled={!mayChange} leftSection={<IconSend size={14} aria-hidden />}>
            Publish
          </Button>
        }
      />
    </>
  )
}
