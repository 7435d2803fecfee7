/** One parameter: what it is for, its value, and the field that sets it. */
import { lookup } from '../../document/dict'
import { Button } from '@mantine/core'
import { useState } from 'react'
import { bus } from '../../api/bus'
import { wordsOf } from '../../api/client'
import { ValueTree } from '../../components/ValueTree'
import { valueField } from '../../document/requestForm'
import { nameOfPath } from '../../document/path'
import { Caution, Detail } from './Detail'
import { RequestForm } from './RequestForm'
import { useForm } from './useForm'
import type { ParameterInfo } from '../../api/types'

interface ParameterViewProps {
  readonly facts: ParameterInfo
  readonly mayChange: boolean
  readonly onBack: () => void
}

export function ParameterView({ facts, mayChange, onBack }: ParameterViewProps) {
  const name = nameOfPath(facts.name)
  // As the value was when it was chosen: what is typed is not lost when somebody else sets it.
  const [fields] = useState(() => [valueField(name, facts.schema, facts.value)])
  const form = useForm({ value: fields, problem: undefined })
  const [value, setValue] = useState<unknown>(facts.value)
  const [refusal, setRefusal] = useState('')

  async function set(next: unknown): Promise<void> {
    setRefusal('')
    await bus.setParameter(facts.name, next).then(setValue, (error: unknown) => setRefusal(wordsOf(error)))
  }

  return (
    <Detail name={facts.name} type="parameter" doc={facts.doc} onBack={onBack}>
      <ValueTree label={`Value of ${facts.name}`} value={value} />
      <Caution mayChange={mayChange} words="This takes effect at once and may move the robot." />
      <RequestForm
        label={`Set ${facts.name}`}
        form={form}
        isOff={!mayChange}
        onSend={(filled) => void set(lookup(filled, name))}
        refusal={refusal}
        buttons={
          <Button type="submit" size="xs" disabled={!mayChange}>
            Set
          </Button>
        }
      />
    </Detail>
  )
}
