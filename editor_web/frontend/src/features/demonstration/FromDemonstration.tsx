/** A button that opens the dialog in which taught entries become a behavior. */
import { IconHandFinger } from '@tabler/icons-react'
import { Suspense, useState } from 'react'
import { Dialog } from '../../components/Dialog'
import { lazyView } from '../../components/lazyView'

const Demonstration = lazyView(async () => (await import('./Demonstration')).Demonstration)

export function FromDemonstration({ onMade }: { onMade: (id: string) => void }) {
  const [isOpen, setOpen] = useState(false)
  return (
    <>
      <button type="button" className="command is-quiet" onClick={() => setOpen(true)}>
        <IconHandFinger size={14} aria-hidden /> From demonstration
      </button>
      <Dialog isOpen={isOpen} title="Behavior from demonstration" onClose={() => setOpen(false)}>
        <Suspense fallback={<div className="page-wait" role="status" aria-label="Loading" />}>
          <Demonstration
            onMade={(id) => {
              setOpen(false)
              onMade(id)
            }}
          />
        </Suspense>
      </Dialog>
    </>
  )
}
