/** Starts a run with what stands in the form of parameters. */
import { Button } from '@mantine/core'
import { IconPlayerPlayFilled } from '@tabler/icons-react'
import { showRefusal } from '../../api/refusal'
import { FORM_ID } from './ParameterForm'
import { useSharedStart } from './StartProvider'

export interface StartButtonProps {
  /** Why it cannot be started now; undefined when it can. */
  readonly obstacle: string | undefined
  /** Called when a value is wrong, as the form shows it. */
  readonly onWrong: () => void
}

/** It is the form's, for the key Enter in a field; a press does not need the form, which may be drawn later than the button. */
export function StartButton({ obstacle, onWrong }: StartButtonProps) {
  const { submit, damage } = useSharedStart()
  return (
    <Button
      type="submit"
      form={FORM_ID}
      data-tour="start"
      size="sm"
      leftSection={<IconPlayerPlayFilled size={14} aria-hidden />}
      disabled={obstacle !== undefined}
      title={obstacle}
      onClick={(event) => {
        event.preventDefault()
        if (damage) showRefusal('Start', 'its parameters cannot be read')
        else void submit().then((isRight) => !isRight && onWrong())
      }}
    >
      Start
    </Button>
  )
}
