/** A button that opens the dialog in which taught entries become a behavior. */
import { Button } from '@mantine/core'
import { IconHandFinger } from '@tabler/icons-react'
import { useState } from 'react'
import { Dialog } from '../../components/Dialog'
import { WhileLoading, lazyView } from '../../components/lazyView'

const Demonstration = lazyView(async () => (await import('./Demonstration')).Demonstration)

export function FromDemonstration({ onMade }: { onMade: (id: string) => void }) {
  const [isOpen, setOpen] = useState(false)
  return (
    <>
      <Button
        variant="subtle"
        color="gray"
        size="xs"
        px="xs"
        justify="flex-start"
        leftSection={<IconHandFinger size={14} aria-hidden />}
        onClick={() => setOpen(true)}
      >
        From demonstration
      </Button>
      <Dialog isOpen={isOpen} title="Behavior from demonstration" onClose={() => setOpen(false)}>
        <WhileLoading value={<div role="status" aria-label="Loading" />}>
          <Demonstration
            onMade={(id) => {
              setOpen(false)
              onMade(id)
            }}
          />
        </WhileLoading>
      </Dialog>
    </>
  )
}
