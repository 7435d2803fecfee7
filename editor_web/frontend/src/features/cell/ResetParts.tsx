/** Puts the parts of a simulated cell back for the next trial. */
import { Button, Text } from '@mantine/core'
import { IconRestore } from '@tabler/icons-react'
import { useState } from 'react'
import { api } from '../../api/client'

export function ResetParts({ isBusy }: { isBusy: boolean }) {
  const { reset, outcome } = useReset()
  return (
    <>
      <Text span role="status" size="sm" c="dimmed">
        {outcome}
      </Text>
      <Button
        size="compact-sm"
        variant="default"
        title="Reset parts"
        leftSection={<IconRestore size={14} aria-hidden />}
        disabled={isBusy}
        onClick={reset}
      >
        Reset parts
      </Button>
    </>
  )
}

function useReset() {
  const [outcome, setOutcome] = useState('')
  const reset = () => {
    api.resetParts().then(
      () => setOutcome('Parts are back'),
      (error: unknown) => setOutcome(error instanceof Error ? error.message : String(error)),
    )
  }
  return { reset, outcome }
}
